// A Coin scene (Open Inventor, FreeCAD's scene graph) in a GLFW window: a red sheet, and a callback node in
// which the library draws a CAD model with the camera, model matrix and viewport that Coin's traversal has
// there.
//
//   coin_host MODEL [--frames N] [--picture FILE.png] [--alone]
#include <GLFW/glfw3.h>
#include <Inventor/C/glue/gl.h>
#include <Inventor/SoDB.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoCacheElement.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/elements/SoModelMatrixElement.h>
#include <Inventor/elements/SoProjectionMatrixElement.h>
#include <Inventor/elements/SoViewingMatrixElement.h>
#include <Inventor/elements/SoViewportRegionElement.h>
#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoCallback.h>
#include <Inventor/nodes/SoCube.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoTranslation.h>

#include "host_common.h"

namespace {

constexpr int kWidth = 640, kHeight = 480;

/// A model as a part of a Coin scene. Its OpenGL objects belong to the context that it was first drawn in.
class ExactShape {
 public:
  explicit ExactShape(std::shared_ptr<const dupin::PreparedModel> model) : model_(std::move(model)) {}

  /// For SoCallback::setCallback.
  static void traverse(void* self, SoAction* action) {
    if (action->isOfType(SoGLRenderAction::getClassTypeId()))
      static_cast<ExactShape*>(self)->draw(action->getState());
  }
  /// With the context current, before it goes.
  void forget_context() { scene_.reset(); }
  const dupin::Status& status() const { return status_; }

 private:
  void draw(SoState* state) {
    SoCacheElement::invalidate(state);  // never part of a display list
    const cc_glglue* glue = cc_glglue_instance(SoGLCacheContextElement::get(state));
    const dupin::GetProcAddress loader = [glue](const char* name) {
      return cc_glglue_getprocaddress(glue, name);
    };
    if (!scene_) {
      auto made = dupin::HostScene::create(loader);
      if (!made) {
        status_ = made.status();
        return;
      }
      scene_ = std::move(*made);
      (void)scene_->add(model_);
    }
    status_ = example::draw(*scene_, view_of(state), {}, loader);
  }

  /// Coin's matrices act on rows, and lie in memory as OpenGL's.
  static dupin::HostView view_of(SoState* state) {
    dupin::HostView view;
    SbMatrix to_eye = SoModelMatrixElement::get(state);
    to_eye.multRight(SoViewingMatrixElement::get(state));
    const SbMatrix& projection = SoProjectionMatrixElement::get(state);
    for (int i = 0; i < 16; ++i) {
      view.view[static_cast<std::size_t>(i)] = to_eye[i / 4][i % 4];
      view.projection[static_cast<std::size_t>(i)] = projection[i / 4][i % 4];
    }
    const SbViewportRegion& region = SoViewportRegionElement::get(state);
    const SbVec2s origin = region.getViewportOriginPixels(), size = region.getViewportSizePixels();
    view.viewport = {origin[0], origin[1], size[0], size[1]};
    return view;
  }

  std::shared_ptr<const dupin::PreparedModel> model_;
  std::unique_ptr<dupin::HostScene> scene_;
  dupin::Status status_;
};

SbVec3f coin(const dupin::Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

SoSeparator* scene_of(const dupin::Box3& box, const example::Look& look, ExactShape& shape, bool sheet) {
  auto* root = new SoSeparator;
  auto* camera = new SoPerspectiveCamera;
  camera->position = coin(look.eye);
  camera->pointAt(coin(look.target), coin(look.up));
  camera->heightAngle = static_cast<float>(look.fov_degrees * M_PI / 180);
  camera->nearDistance = static_cast<float>(look.near), camera->farDistance = static_cast<float>(look.far);
  root->addChild(camera);
  if (sheet) {
    auto* own = new SoSeparator;
    auto* plain = new SoLightModel;
    plain->model = SoLightModel::BASE_COLOR;
    auto* color = new SoBaseColor;
    color->rgb = SbColor(1, 0, 0);
    auto* place = new SoTranslation;
    place->translation = coin(box.center());
    auto* cube = new SoCube;
    cube->width = cube->depth = static_cast<float>(0.9 * box.diagonal());
    cube->height = static_cast<float>(0.002 * box.diagonal());
    own->addChild(plain), own->addChild(color), own->addChild(place), own->addChild(cube);
    root->addChild(own);
  }
  auto* callback = new SoCallback;
  callback->setCallback(&ExactShape::traverse, &shape);
  root->addChild(callback);
  return root;
}

bool save(const char* path) {
  std::vector<unsigned char> rgba(static_cast<std::size_t>(4 * kWidth * kHeight));
  glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  return example::write(path, rgba, kWidth, kHeight, 4);
}

}  // namespace

int main(int argc, char** argv) {
  const example::Arguments arguments = example::arguments(argc, argv);
  if (!arguments.model)
    return example::fail("usage: coin_host MODEL [--frames N] [--picture FILE.png] [--alone]");
  if (!glfwInit()) return example::fail("no display");
  GLFWwindow* window = glfwCreateWindow(kWidth, kHeight, "Dupin in Coin", nullptr, nullptr);
  if (!window) return example::fail("no window with OpenGL");
  glfwMakeContextCurrent(window);
  SoDB::init();
  const auto prepared = dupin::LoadJob::start(arguments.model, {}, {})->result();
  if (!prepared) return example::fail(prepared.status().message);
  const dupin::Box3 box = dupin::bounding_box(*(*prepared)->model);
  const example::Look look = example::look_at(box, 0.6);
  int code = 0;
  ExactShape shape(*prepared);
  SoSeparator* root = scene_of(box, look, shape, !arguments.alone);
  root->ref();
  glViewport(0, 0, kWidth, kHeight);
  glEnable(GL_DEPTH_TEST);
  {
    SoGLRenderAction action(SbViewportRegion(kWidth, kHeight));
    action.setCacheContext(SoGLCacheContextElement::getUniqueCacheContext());
    for (int i = 0; i < std::max(1, arguments.frames); ++i) {
      glClearColor(1, 1, 1, 1);
      glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
      action.apply(root);
      if (!shape.status().ok()) code = example::fail(shape.status().message);
    }
    example::print_camera(look, kWidth, kHeight);
    if (code == 0 && arguments.picture && !save(arguments.picture))
      code = example::fail("no picture could be written");
  }
  root->unref();
  shape.forget_context();
  glfwDestroyWindow(window);
  glfwTerminate();
  return code;
}
