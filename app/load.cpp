#include "load.h"

#include <chrono>
#include <iterator>
#include <utility>

#include "tree_files.h"

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

namespace {

/// One file after the other.
class Loading {
 public:
  Loading(Session& session, const LoadOptions& options) : session_(session), options_(options) {}

  Status add(const std::string& file) {
    const bool is_tree = is_tree_file(file);
    const std::string kept = is_tree ? file : kept_file(file);
    if (is_tree || !kept.empty()) {
      const Status status = add_tree(kept, file);
      // A kept tree that is not there, or not to be used, is made again.
      if (status.ok() || is_tree) return status;
    }
    Result<Model> model = import(file);
    if (!model.ok()) return model.status();
    // Only a file that is one mesh is its tree.
    const bool one_mesh =
        model->parts.size() == 1 && model->parts[0].faces.empty() && model->instances.size() == 1;
    add(std::move(*model), nullptr, one_mesh ? kept : std::string{});
    return {};
  }

  Loaded take() { return std::move(loaded_); }

 private:
  std::string kept_file(const std::string& file) const {
    if (!options_.trees || options_.tree_folder.empty()) return {};
    return kept_tree(options_.tree_folder, file, session_.options().units, options_.kind);
  }

  Status add_tree(const std::string& path, const std::string& file) {
    const auto tree = open_point_tree(path);
    if (!tree.ok()) return tree.status();
    const bool as_it_is =
        options_.trees && (options_.kind == PointTreeKind::pop || (*tree)->info().kind == options_.kind);
    Result<Model> model = model_of_tree(**tree, file, !as_it_is);
    if (!model.ok()) return model.status();
    add(std::move(*model), as_it_is ? *tree : nullptr, {});
    return {};
  }

  Result<Model> import(const std::string& file) {
    ImportOptions import;
    import.time_limit_seconds = session_.limits().seconds_left();
    import.memory_limit_bytes = session_.limits().bytes();
    import.assumed_unit = session_.options().units;
    import.mesh_deflection = options_.mesh_deflection;
    import.progress = session_.progress();
    return import_cad(file, import);
  }

  void add(Model model, std::shared_ptr<const PointTree> tree, const std::string& tree_file) {
    const std::size_t parts = model.parts.size();
    if (loaded_.model.parts.empty() && loaded_.model.source.empty())
      loaded_.model = std::move(model);
    else
      merge(loaded_.model, std::move(model));
    loaded_.trees.resize(loaded_.model.parts.size());
    loaded_.tree_files.resize(loaded_.model.parts.size());
    if (parts > 0) loaded_.trees.back() = std::move(tree), loaded_.tree_files.back() = tree_file;
  }

  Session& session_;
  const LoadOptions& options_;
  Loaded loaded_;
};

}  // namespace

Result<Loaded> load(Session& session, const std::vector<std::string>& files, const LoadOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Loading loading(session, options);
  for (const std::string& file : files)
    if (const Status status = loading.add(file); !status.ok()) return status;
  Loaded loaded = loading.take();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  loaded.import_seconds = std::max(0.0, seconds - loaded.model.mesh_seconds);
  return loaded;
}

}  // namespace dupin::app
