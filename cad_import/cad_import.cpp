#include "cad_import.h"

namespace dupin {
Result<Model> import_cad(const std::string&, const ImportOptions&) { return {StatusCode::unreadable, "no reader yet"}; }
}
