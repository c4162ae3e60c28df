// Walking an XDE document (what OCCT's STEP and IGES readers make): assemblies, names, colours.
#ifndef DUPIN_CAD_IMPORT_READER_XDE_DOCUMENT_H
#define DUPIN_CAD_IMPORT_READER_XDE_DOCUMENT_H

#include <TDocStd_Document.hxx>

#include "source_document.h"

namespace dupin::reader {

Handle(TDocStd_Document) new_xde_document();

/// Adds every placed shape of the document.
void add_items(const Handle(TDocStd_Document) & document, SourceDocument& out);

}  // namespace dupin::reader

#endif
