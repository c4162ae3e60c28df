// Faces of a STEP file that never became shapes.
#ifndef DUPIN_CAD_IMPORT_READER_STEP_FACES_H
#define DUPIN_CAD_IMPORT_READER_STEP_FACES_H

#include <XSControl_WorkSession.hxx>

#include "source_document.h"

namespace dupin::reader {

/// Lists the file's face entities that the translation was asked for and gave nothing, and notes those that
/// no shape uses. OCCT leaves both out without a word.
void report_lost_faces(const Handle(XSControl_WorkSession) & session, SourceDocument& document);

}  // namespace dupin::reader

#endif
