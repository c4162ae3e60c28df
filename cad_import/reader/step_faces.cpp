#include "step_faces.h"

#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_UndefinedContent.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>

namespace dupin::reader {
namespace {

class LostFaces {
 public:
  explicit LostFaces(const Handle(XSControl_WorkSession) & session)
      : model_(Handle(StepData_StepModel)::DownCast(session->Model())),
        process_(session->TransferReader()->TransientProcess()),
        graph_(session->Graph()) {}

  void report(SourceDocument& document) {
    int unused = 0;
    for (int i = 1; i <= model_->NbEntities(); ++i) {
      const Handle(StepShape_FaceSurface) face = Handle(StepShape_FaceSurface)::DownCast(model_->Value(i));
      if (face.IsNull() || has_shape(face)) continue;
      std::string reason;
      if (was_asked_for(face, reason, 0))
        document.skipped.push_back({name_of(face), reason, 1});
      else
        ++unused;
    }
    report_triangles(document);
    if (unused > 0)
      document.notes.push_back(std::to_string(unused) +
                               " faces of the file belong to no shape and are left out");
  }

 private:
  static constexpr int kLevelsUp = 4;  // face, shell, solid, representation

  // AP242's faces that are triangles only; those that stand for an exact face link to it.
  void report_triangles(SourceDocument& document) const {
    constexpr int kLink = 5;  // name, coordinates, count, normals, link, …
    std::uint32_t count = 0;
    for (int i = 1; i <= model_->NbEntities(); ++i) {
      const Handle(StepData_UndefinedEntity) entity =
          Handle(StepData_UndefinedEntity)::DownCast(model_->Value(i));
      if (entity.IsNull()) continue;
      const std::string_view type = entity->StepType();
      if (type != "TRIANGULATED_FACE" && type != "COMPLEX_TRIANGULATED_FACE") continue;
      const Handle(Interface_UndefinedContent) content = entity->UndefinedContent();
      if (content->NbParams() < kLink || !content->IsParamEntity(kLink)) ++count;
    }
    if (count > 0)
      document.skipped.push_back(
          {"faces of triangles", "the file has them as triangles only, without their surfaces", count});
  }

  bool has_shape(const Handle(Standard_Transient) & entity) const {
    const Handle(Transfer_Binder) binder = process_->Find(entity);
    return !binder.IsNull() && !TransferBRep::ShapeResult(binder).IsNull();
  }

  // The translation came to the face, or to something it is a part of, and failed there.
  bool was_asked_for(const Handle(Standard_Transient) & entity, std::string& reason, int level) const {
    const Handle(Transfer_Binder) binder = process_->Find(entity);
    if (!binder.IsNull()) {
      if (level > 0 && !TransferBRep::ShapeResult(binder).IsNull())
        return reason = "the CAD kernel dropped it", true;
      reason = why(binder);
      return true;
    }
    if (level == kLevelsUp) return false;
    for (Interface_EntityIterator user = graph_.Sharings(entity); user.More(); user.Next())
      if (was_asked_for(user.Value(), reason, level + 1)) return true;
    return false;
  }

  static std::string why(const Handle(Transfer_Binder) & binder) {
    const Handle(Interface_Check) check = binder->Check();
    std::string text = "the CAD kernel could not build it";
    if (check->HasFailed())
      text += std::string(": ") + check->CFail(1);
    else if (check->HasWarnings())
      text += std::string(": ") + check->CWarning(1);
    return text;
  }

  std::string name_of(const Handle(StepShape_FaceSurface) & face) const {
    if (!face->Name().IsNull() && face->Name()->Length() > 0) return face->Name()->ToCString();
    return "face #" + std::to_string(model_->IdentLabel(face));
  }

  Handle(StepData_StepModel) model_;
  Handle(Transfer_TransientProcess) process_;
  const Interface_Graph& graph_;
};

}  // namespace

void report_lost_faces(const Handle(XSControl_WorkSession) & session, SourceDocument& document) {
  if (!session->Model().IsNull() && !session->TransferReader().IsNull()) LostFaces(session).report(document);
}

}  // namespace dupin::reader
