#include "canvas.h"

#include <QMouseEvent>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QWheelEvent>
#include <chrono>
#include <cmath>

namespace dupin::app {
namespace {

constexpr int kRestMilliseconds = 150, kClickPixels = 3;
constexpr double kBuildMilliseconds = 10;  // of a frame's, so that input is heard between them
constexpr Color kSelected{1.0F, 0.45F, 0.02F, 1};

}  // namespace

Canvas::Canvas(QWidget* parent) : QOpenGLWidget(parent) {
  setUpdateBehavior(PartialUpdate);  // the last picture stays until the next is ready
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(160, 120);
  rest_.setSingleShot(true);
  rest_.setInterval(kRestMilliseconds);
  connect(&rest_, &QTimer::timeout, this, [this] { refine(); });
}

Canvas::~Canvas() {
  makeCurrent();
  scene_.reset();
  doneCurrent();
}

void Canvas::initializeGL() {
  QOpenGLContext* context = QOpenGLContext::currentContext();
  auto made = HostScene::create(
      [context](const char* name) { return reinterpret_cast<void*>(context->getProcAddress(name)); });
  if (made)
    scene_ = std::move(*made);
  else if (failed)
    failed(made.status().message);
}

void Canvas::resizeGL(int width, int height) {
  camera.resize(in_pixels({width, height}).x(), in_pixels({width, height}).y());
  empty_ = true;
}

void Canvas::clear() {
  QOpenGLFunctions* gl = QOpenGLContext::currentContext()->functions();
  gl->glClearColor(0.93F, 0.94F, 0.96F, 1);
  gl->glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl->glEnable(GL_DEPTH_TEST);
  empty_ = false;
}

/// New objects are made ready a slice at a time, with the last picture left on the screen.
bool Canvas::ready() {
  if (!preparing_) return true;
  const auto done = scene_->get_ready(camera.view(), options, kBuildMilliseconds);
  preparing_ = done && !*done;  // what failed, draw says
  return !preparing_;
}

void Canvas::paintGL() {
  if (scene_ && !ready()) {
    if (empty_) clear();
    QTimer::singleShot(0, this, [this] { update(); });
    return;
  }
  clear();
  if (!scene_) return;
  const Status status = scene_->draw(camera.view(), options, &stats_);
  ++frames_;
  if (!status.ok() && failed) failed(status.message);
  if (drawn) drawn(stats_);
  if (stats_.bound_px > tolerance_px) rest_.start();
}

void Canvas::changed() {
  update();
}

ObjectId Canvas::add(std::shared_ptr<const PreparedModel> model) {
  if (!scene_) return 0;
  const auto id = scene_->add(std::move(model));
  preparing_ = preparing_ || id.ok();
  changed();
  return id ? *id : 0;
}

void Canvas::remove(ObjectId object) {
  if (!scene_) return;
  if (selected_ && selected_->object == object) selected_.reset();
  (void)scene_->remove(object);
  changed();
}

void Canvas::set_visible(const Target& target, bool visible) {
  if (!scene_) return;
  makeCurrent();
  (void)scene_->set_visible(target, visible);
  doneCurrent();
  changed();
}

void Canvas::select(const std::optional<Target>& target) {
  if (!scene_) return;
  makeCurrent();
  if (selected_) (void)scene_->set_highlight(*selected_, {});
  selected_ = target;
  if (selected_) (void)scene_->set_highlight(*selected_, kSelected);
  doneCurrent();
  changed();
}

void Canvas::refit_box() {
  if (scene_) camera.set_box(scene_->box());
}

void Canvas::pick(const QPoint& at) {
  if (!scene_) return;
  makeCurrent();
  const QPoint pixel = in_pixels(at);
  const HostView view = camera.view();
  const auto hit = scene_->pick(view, pixel.x(), view.viewport[3] - 1 - pixel.y(), options);
  doneCurrent();
  if (!hit) {
    if (failed) failed(hit.status().message);
    return;
  }
  select(*hit ? std::optional<Target>((*hit)->target) : std::nullopt);
  if (picked) picked(*hit);
}

/// The camera rests: what it sees is prepared more finely, beside the window.
void Canvas::refine() {
  if (!scene_ || stats_.bound_px <= tolerance_px) return;
  makeCurrent();
  const Status status = scene_->refine(camera.view(), tolerance_px, [this] {
    QMetaObject::invokeMethod(
        this, [this] { update(); }, Qt::QueuedConnection);
  });
  doneCurrent();
  if (!status.ok() && failed) failed(status.message);
}

// ---- input: turn with the left button, move with the middle one (or with Shift), zoom with the right one or
// the wheel; a click picks.

void Canvas::mousePressEvent(QMouseEvent* event) {
  pressed_ = last_ = event->pos();
  dragged_ = false;
}

void Canvas::mouseMoveEvent(QMouseEvent* event) {
  const std::chrono::duration<double, std::milli> now = std::chrono::steady_clock::now().time_since_epoch();
  if (heard) heard(now.count() - static_cast<double>(event->timestamp()));
  if ((event->pos() - pressed_).manhattanLength() > kClickPixels) dragged_ = true;
  if (!dragged_ || event->buttons() == Qt::NoButton) return;
  const QPoint step = in_pixels(event->pos() - last_);
  last_ = event->pos();
  if (event->buttons() & Qt::MiddleButton || event->modifiers() & Qt::ShiftModifier)
    camera.pan(step.x(), step.y());
  else if (event->buttons() & Qt::RightButton)
    camera.zoom(std::exp(-0.01 * step.y()), 0.5 * in_pixels({width(), 0}).x(),
                0.5 * in_pixels({0, height()}).y());
  else
    camera.orbit(step.x(), step.y());
  changed();
}

void Canvas::mouseReleaseEvent(QMouseEvent* event) {
  if (!dragged_ && event->button() == Qt::LeftButton) pick(event->pos());
}

void Canvas::wheelEvent(QWheelEvent* event) {
  const QPoint at = in_pixels(event->position().toPoint());
  camera.zoom(std::pow(1.25, event->angleDelta().y() / 120.0), at.x(), at.y());
  changed();
}

}  // namespace dupin::app
