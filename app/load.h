// Reading the files that a command names.
#ifndef DUPIN_APP_LOAD_H
#define DUPIN_APP_LOAD_H

#include <string>
#include <vector>

#include "../cad_import/cad_import.h"
#include "../nurbs/model.h"
#include "session.h"

namespace dupin::app {

struct Loaded {
  Model model;
  double import_seconds = 0;  ///< without the tessellation, which is Model::mesh_seconds
};

/// Reads the files and puts their models, each where it stands in its own space, into one. `mesh_deflection`
/// as in ImportOptions.
Result<Loaded> load(Session& session, const std::vector<std::string>& files, double mesh_deflection = 0);

/// Adds what `other` holds to `model`.
void merge(Model& model, Model other);

/// How many face instances could not be read.
std::size_t skipped_count(const std::vector<SkippedFace>& skipped);

}  // namespace dupin::app

#endif
