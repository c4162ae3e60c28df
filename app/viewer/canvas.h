// The 3D view: the scene, its camera, and what mouse and wheel do to it.
#ifndef DUPIN_APP_VIEWER_CANVAS_H
#define DUPIN_APP_VIEWER_CANVAS_H

#include <QOpenGLWidget>
#include <QPoint>
#include <QTimer>

#include "../../host/host_scene.h"
#include "orbit_camera.h"

namespace dupin::app {

class Canvas : public QOpenGLWidget {
 public:
  explicit Canvas(QWidget* parent = nullptr);
  ~Canvas() override;

  std::function<void(const std::optional<Hit>&)> picked;
  std::function<void(const FrameStats&)> drawn;
  std::function<void(const std::string&)> failed;
  OrbitCamera camera;
  DrawOptions options;
  double tolerance_px = 0.5;

  /// 0 where there is no OpenGL.
  ObjectId add(std::shared_ptr<const PreparedModel> model);
  void remove(ObjectId object);
  void set_visible(const Target& target, bool visible);
  /// Highlights it in place of what was; none: nothing.
  void select(const std::optional<Target>& target);
  HostScene* scene() { return scene_.get(); }
  /// The box of everything in it, for the camera.
  void refit_box();
  void changed();  ///< something is to be drawn anew
  int frames() const { return frames_; }
  /// Something was added that is not drawn yet.
  bool preparing() const { return preparing_; }
  /// How long a move of the pointer waited for its turn, by the X server's clock.
  std::function<void(double milliseconds)> heard;

 protected:
  void initializeGL() override;
  void resizeGL(int width, int height) override;
  void paintGL() override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

 private:
  void pick(const QPoint& at);
  void refine();
  bool ready();
  void clear();
  QPoint in_pixels(const QPoint& at) const { return at * devicePixelRatio(); }

  std::unique_ptr<HostScene> scene_;
  std::optional<Target> selected_;
  QPoint pressed_, last_;
  bool dragged_ = false, preparing_ = false, empty_ = true;
  QTimer rest_;
  FrameStats stats_;
  int frames_ = 0;
};

}  // namespace dupin::app

#endif
