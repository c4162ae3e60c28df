#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Reader.hxx>

#include "kernel_progress.h"
#include "read_files.h"
#include "step_faces.h"
#include "xde_document.h"

namespace dupin::reader {

Result<SourceDocument> read_step(const std::string& path, const Stage& stage) {
  stage("reading", 0);
  STEPCAFControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  reader.SetLayerMode(false);
  reader.SetPropsMode(false);
  reader.SetGDTMode(false);
  reader.SetMatMode(false);
  reader.SetViewMode(false);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
    return {StatusCode::unreadable, "the STEP file is damaged: it cannot be parsed"};
  stage("building shapes", 0);
  Handle(TDocStd_Document) document = new_xde_document();
  const Handle(KernelProgress) progress = new KernelProgress(stage, "building shapes");
  if (!reader.Transfer(document, progress->Start()))
    return {StatusCode::unreadable, "the STEP file holds no shape that can be built"};
  SourceDocument out{"STEP", "mm"};
  add_items(document, out);
  report_lost_faces(reader.Reader().WS(), out);
  return out;
}

}  // namespace dupin::reader
