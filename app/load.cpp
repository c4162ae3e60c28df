#include "load.h"

#include <chrono>
#include <iterator>
#include <utility>

namespace dupin::app {
namespace {

template <class T>
void append(std::vector<T>& to, std::vector<T>&& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// "a", then "a + b"; what is the same for both stands once.
void join(std::string& text, const std::string& other) {
  if (text != other) text += " + " + other;
}

}  // namespace

void merge(Model& model, Model other) {
  const auto first_part = static_cast<std::uint32_t>(model.parts.size());
  for (Instance& instance : other.instances) instance.part += first_part;
  append(model.parts, std::move(other.parts));
  append(model.instances, std::move(other.instances));
  append(model.skipped, std::move(other.skipped));
  append(model.notes, std::move(other.notes));
  join(model.source, other.source);
  join(model.format, other.format);
  join(model.unit_note, other.unit_note);
  model.mesh_seconds += other.mesh_seconds;
}

std::size_t skipped_count(const std::vector<SkippedFace>& skipped) {
  std::size_t count = 0;
  for (const SkippedFace& face : skipped) count += face.count;
  return count;
}

Result<Loaded> load(Session& session, const std::vector<std::string>& files, double mesh_deflection) {
  Loaded loaded;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < files.size(); ++i) {
    ImportOptions options;
    options.time_limit_seconds = session.limits().seconds_left();
    options.memory_limit_bytes = session.limits().bytes();
    options.assumed_unit = session.options().units;
    options.mesh_deflection = mesh_deflection;
    options.progress = session.progress();
    Result<Model> model = import_cad(files[i], options);
    if (!model.ok()) return model.status();
    if (i == 0)
      loaded.model = std::move(*model);
    else
      merge(loaded.model, std::move(*model));
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  loaded.import_seconds = std::max(0.0, seconds - loaded.model.mesh_seconds);
  return loaded;
}

}  // namespace dupin::app
