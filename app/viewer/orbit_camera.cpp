#include "orbit_camera.h"

#include <algorithm>
#include <cmath>

#include "../../render/view.h"

namespace dupin::app {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTurnPerPixel = kPi / 500;
constexpr double kMargin = 1.05;

/// Of a direction, about a unit axis.
Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

}  // namespace

void OrbitCamera::resize(int width, int height) {
  width_ = std::max(1, width), height_ = std::max(1, height);
}

double OrbitCamera::tangent() const {
  return std::tan(fov_degrees_ * kPi / 360);
}

double OrbitCamera::pixel() const {
  return 2 * distance_ * tangent() / height_;
}

void OrbitCamera::set_axes(const Vec3& back, const Vec3& up) {
  back_ = normalized(back);
  right_ = normalized(cross(up, back_));
  up_ = cross(back_, right_);
}

void OrbitCamera::look_from(std::string_view name) {
  Camera settings;
  settings.width = width_, settings.height = height_;
  const auto camera = fit_view(box_, name, settings);
  if (!camera) return;
  const CameraAxes axes = camera_axes(*camera);
  right_ = axes.right, up_ = axes.up, back_ = axes.back;
  fit();
}

void OrbitCamera::fit() {
  if (box_.empty()) return;
  center_ = box_.center();
  const double ty = tangent(), tx = ty * width_ / height_;
  double needed = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p = box_.corner(i) - center_;
    const double across = std::max(std::abs(dot(p, right_)) / tx, std::abs(dot(p, up_)) / ty);
    needed = std::max(needed, across + (parallel_ ? 0 : dot(p, back_)));
  }
  distance_ = std::max(kMargin * needed, 1e-9);
}

void OrbitCamera::orbit(double dx, double dy) {
  const Vec3 vertical{0, 0, 1};
  Vec3 back = turned(back_, vertical, -dx * kTurnPerPixel), up = turned(up_, vertical, -dx * kTurnPerPixel);
  const Vec3 right = normalized(cross(up, back));
  back = turned(back, right, -dy * kTurnPerPixel), up = turned(up, right, -dy * kTurnPerPixel);
  set_axes(back, up);
}

void OrbitCamera::pan(double dx, double dy) {
  center_ += (up_ * dy - right_ * dx) * pixel();
}

void OrbitCamera::zoom(double factor, double x, double y) {
  const Vec3 offset = (right_ * (x - 0.5 * width_) + up_ * (0.5 * height_ - y)) * pixel();
  distance_ /= factor;
  center_ += offset * (1 - 1 / factor);
}

Camera OrbitCamera::camera() const {
  Camera camera;
  camera.eye = center_ + back_ * distance_;
  camera.target = center_;
  camera.up = up_;
  camera.fov_degrees = fov_degrees_;
  camera.orthographic = parallel_;
  camera.ortho_height = 2 * distance_ * tangent();
  camera.width = width_, camera.height = height_;
  return camera;
}

HostView OrbitCamera::view() const {
  const Vec3 eye = center_ + back_ * distance_;
  const double radius = box_.empty() ? 1 : box_.diagonal() / 2 + distance(center_, box_.center());
  HostView view;
  view.view = {right_.x, up_.x, back_.x, 0, right_.y,          up_.y,          back_.y,          0,
               right_.z, up_.z, back_.z, 0, -dot(right_, eye), -dot(up_, eye), -dot(back_, eye), 1};
  view.viewport = {0, 0, width_, height_};
  const double aspect = static_cast<double>(width_) / height_, far = distance_ + radius;
  if (parallel_) {
    const double half = distance_ * tangent(), near = distance_ - radius;
    view.projection = {
        1 / (half * aspect),          0, 0, 0, 0, 1 / half, 0, 0, 0, 0, -2 / (far - near), 0, 0, 0,
        -(far + near) / (far - near), 1};
  } else {
    const double f = 1 / tangent(), near = std::max(distance_ - radius, 1e-4 * far);
    view.projection = {f / aspect,
                       0,
                       0,
                       0,
                       0,
                       f,
                       0,
                       0,
                       0,
                       0,
                       (far + near) / (near - far),
                       -1,
                       0,
                       0,
                       2 * far * near / (near - far),
                       0};
  }
  return view;
}

}  // namespace dupin::app
