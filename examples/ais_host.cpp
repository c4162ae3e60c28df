// Open CASCADE's viewer (AIS), in an X window: a red sheet that it tessellates and draws as always, and an
// interactive object that is drawn by the library instead.
//
//   ais_host MODEL [--picture FILE.png] [--alone]
#include "host_common.h"

#include <AIS_InteractiveContext.hxx>
#include <AIS_Shape.hxx>
#include <Aspect_DisplayConnection.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <Graphic3d_Camera.hxx>
#include <Image_PixMap.hxx>
#include <OpenGl_Context.hxx>
#include <OpenGl_Element.hxx>
#include <OpenGl_GraphicDriver.hxx>
#include <OpenGl_Group.hxx>
#include <OpenGl_View.hxx>
#include <OpenGl_Workspace.hxx>
#include <Prs3d_Presentation.hxx>
#include <V3d_View.hxx>
#include <V3d_Viewer.hxx>
#include <Xw_Window.hxx>

#include <GL/glx.h>
#undef Status  // X's
#undef None

namespace {

constexpr int kWidth = 640, kHeight = 480;

void* function(const char* name) {
  return reinterpret_cast<void*>(glXGetProcAddressARB(reinterpret_cast<const GLubyte*>(name)));
}

/// What a frame of Open CASCADE calls among its own primitives.
class ExactElement final : public OpenGl_Element {
 public:
  explicit ExactElement(std::shared_ptr<const dupin::PreparedModel> model) : model_(std::move(model)) {}

  void Render(const Handle(OpenGl_Workspace) & workspace) const override {
    if (!scene_) {
      auto made = dupin::HostScene::create(function);
      status_ = made.status();
      if (!made) return;
      scene_ = std::move(*made);
      (void)scene_->add(model_);
    }
    dupin::HostView view;
    const Handle(Graphic3d_Camera) camera = workspace->View()->Camera();
    const Graphic3d_Mat4d& to_eye = camera->OrientationMatrix();
    const Graphic3d_Mat4d& projection = camera->ProjectionMatrix();
    for (std::size_t i = 0; i < 16; ++i)
      view.view[i] = to_eye.GetData()[i], view.projection[i] = projection.GetData()[i];
    const Standard_Integer* port = workspace->GetGlContext()->Viewport();
    view.viewport = {port[0], port[1], port[2], port[3]};
    status_ = example::draw(*scene_, view, {}, function);
  }
  void Release(OpenGl_Context*) override { scene_.reset(); }  // the context is current
  const dupin::Status& status() const { return status_; }

 private:
  std::shared_ptr<const dupin::PreparedModel> model_;
  mutable std::unique_ptr<dupin::HostScene> scene_;
  mutable dupin::Status status_;
};

class ExactObject final : public AIS_InteractiveObject {
 public:
  DEFINE_STANDARD_RTTI_INLINE(ExactObject, AIS_InteractiveObject)
  explicit ExactObject(std::shared_ptr<const dupin::PreparedModel> model) : model_(std::move(model)) {}
  const dupin::Status& status() const { return element_->status(); }

 private:
  void Compute(const Handle(PrsMgr_PresentationManager) &, const Handle(Prs3d_Presentation) & presentation,
               const Standard_Integer) override {
    const Handle(OpenGl_Group) group = Handle(OpenGl_Group)::DownCast(presentation->NewGroup());
    const dupin::Box3 box = dupin::bounding_box(*model_->model);
    // For what Open CASCADE culls and fits by.
    group->SetMinMaxValues(box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z);
    element_ = new ExactElement(model_);
    group->AddElement(element_);  // which owns it
  }
  void ComputeSelection(const Handle(SelectMgr_Selection) &, const Standard_Integer) override {}

  std::shared_ptr<const dupin::PreparedModel> model_;
  ExactElement* element_ = nullptr;
};

gp_Pnt point(const dupin::Vec3& v) {
  return {v.x, v.y, v.z};
}

void place_camera(const Handle(V3d_View) & view, const example::Look& look) {
  const Handle(Graphic3d_Camera) camera = view->Camera();
  camera->SetProjectionType(Graphic3d_Camera::Projection_Perspective);
  camera->SetFOVy(look.fov_degrees);
  camera->SetUp(gp_Dir(look.up.x, look.up.y, look.up.z));
  camera->SetEyeAndCenter(point(look.eye), point(look.target));
  view->SetAutoZFitMode(Standard_False);
  camera->SetZRange(look.near, look.far);
}

void display_sheet(const Handle(AIS_InteractiveContext) & context, const dupin::Box3& box) {
  const dupin::Vec3 m = box.center();
  const double r = 0.45 * box.diagonal(), thin = 0.001 * box.diagonal();
  const gp_Pnt low(m.x - r, m.y - thin, m.z - r);
  const Handle(AIS_Shape) sheet = new AIS_Shape(BRepPrimAPI_MakeBox(low, 2 * r, 2 * thin, 2 * r).Shape());
  sheet->SetColor(Quantity_NOC_RED);
  context->Display(sheet, AIS_Shaded, -1, Standard_False);
}

bool save(const Handle(V3d_View) & view, const char* path) {
  Image_PixMap pixels;
  pixels.InitZero(Image_Format_RGB, kWidth, kHeight);
  if (!view->ToPixMap(pixels, kWidth, kHeight)) return false;
  std::vector<unsigned char> rgb;
  for (int row = kHeight - 1; row >= 0; --row) {  // bottom first; rows of the map are numbered from the top
    const Standard_Byte* start = pixels.Row(static_cast<Standard_Size>(row));
    rgb.insert(rgb.end(), start, start + 3 * kWidth);
  }
  return example::write(path, rgb, kWidth, kHeight, 3);
}

}  // namespace

int main(int argc, char** argv) {
  const example::Arguments arguments = example::arguments(argc, argv);
  if (!arguments.model) return example::fail("usage: ais_host MODEL [--picture FILE.png] [--alone]");
  const auto prepared = dupin::LoadJob::start(arguments.model, {}, {})->result();
  if (!prepared) return example::fail(prepared.status().message);
  const dupin::Box3 box = dupin::bounding_box(*(*prepared)->model);
  const example::Look look = example::look_at(box, 0.6);

  const Handle(Aspect_DisplayConnection) display = new Aspect_DisplayConnection();
  const Handle(OpenGl_GraphicDriver) driver = new OpenGl_GraphicDriver(display);
  const Handle(V3d_Viewer) viewer = new V3d_Viewer(driver);
  viewer->SetDefaultLights(), viewer->SetLightOn();
  const Handle(Xw_Window) window = new Xw_Window(display, "Dupin in AIS", 0, 0, kWidth, kHeight);
  window->Map();
  const Handle(V3d_View) view = viewer->CreateView();
  view->SetWindow(window);
  view->SetBackgroundColor(Quantity_NOC_WHITE);
  place_camera(view, look);

  const Handle(AIS_InteractiveContext) context = new AIS_InteractiveContext(viewer);
  const Handle(ExactObject) exact = new ExactObject(*prepared);
  if (!arguments.alone) display_sheet(context, box);
  context->Display(exact, 0, -1, Standard_False);
  view->Redraw();
  if (!exact->status().ok()) return example::fail(exact->status().message);
  example::print_camera(look, kWidth, kHeight);
  if (arguments.picture && !save(view, arguments.picture))
    return example::fail("no picture could be written");
  context->RemoveAll(Standard_False);
  view->Remove();
  return 0;
}
