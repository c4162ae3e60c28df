#include <IFSelect_ReturnStatus.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <Interface_Static.hxx>

#include "kernel_progress.h"
#include "read_files.h"
#include "xde_document.h"

namespace dupin::reader {

Result<SourceDocument> read_iges(const std::string& path, const Stage& stage) {
  stage("reading", 0);
  IGESCAFControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  reader.SetLayerMode(false);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
    return {StatusCode::unreadable, "the IGES file is damaged: it cannot be parsed"};
  stage("building shapes", 0);
  Handle(TDocStd_Document) document = new_xde_document();
  const Handle(KernelProgress) progress = new KernelProgress(stage, "building shapes");
  if (!reader.Transfer(document, progress->Start()))
    return {StatusCode::unreadable, "the IGES file holds no shape that can be built"};
  SourceDocument out{"IGES", "mm"};
  add_items(document, out);
  return out;
}

}  // namespace dupin::reader
