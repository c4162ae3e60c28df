// dupin tree: a mesh, or a model's tessellation, as a file that is drawn as it lies.
#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "commands.h"
#include "exit_code.h"
#include "load.h"
#include "output_file.h"
#include "point_trees.h"
#include "session.h"

namespace dupin::app {
namespace {

struct TreeCommandOptions {
  CommonOptions common;
  std::string file, output, kind = "pop";
  double deflection = 1e-3;
};

int run(const TreeCommandOptions& options) {
  Session session(options.common);
  OutputFile output;
  if (!options.output.ends_with(".dpt"))
    return session.fail(
        {StatusCode::invalid_argument, options.output + ": a point tree's name ends in .dpt"});
  if (const Status status = output.open(options.output); !status.ok()) return session.fail(status);
  LoadOptions how;
  how.mesh_deflection = options.deflection;
  const Result<Loaded> loaded = load(session, {options.file}, how);
  if (!loaded.ok()) return session.fail(loaded.status());
  const PlacedMesh placed = placed_mesh(loaded->model);
  PointTreeOptions build;
  build.kind = options.kind == "qsplat" ? PointTreeKind::qsplat : PointTreeKind::pop;
  build.source = {loaded->model.source, loaded->model.unit_note, placed.scale};
  build.progress = session.progress();
  const auto tree = build_point_tree(placed.mesh, build);
  if (!tree.ok()) return session.fail({tree.status().code, options.file + ": " + tree.status().message});
  if (const Status status = write_point_tree(**tree, output.working_path()); !status.ok())
    return session.fail({status.code, options.output + ": cannot write"});
  if (const Status status = output.commit(); !status.ok()) return session.fail(status);
  session.done();
  const PointTreeInfo& info = (*tree)->info();
  session.note(std::to_string(info.nodes) + " nodes, " + std::to_string(info.triangles) + " triangles, " +
               std::to_string((*tree)->byte_count() / 1024) + " KiB");
  for (const SkippedFace& face : loaded->model.skipped)
    session.warn("not there: " + face.name + ": " + face.reason);
  return loaded->model.skipped.empty() ? kDone : kPartial;
}

}  // namespace

void add_tree_command(CLI::App& app, Command& chosen) {
  const auto options = std::make_shared<TreeCommandOptions>();
  CLI::App* command = app.add_subcommand("tree", "Make a point tree, a .dpt file, of a mesh");
  command->add_option("FILE", options->file, "A mesh; or a CAD file, which is tessellated")->required();
  command->add_option("-o,--output", options->output, "The tree: .dpt")->required()->type_name("FILE");
  command->add_option("--kind", options->kind, "pop: triangles at the leaves; qsplat: vertices")
      ->check(CLI::IsMember({"pop", "qsplat"}))
      ->capture_default_str();
  command
      ->add_option("--deflection", options->deflection,
                   "Of CAD files: Open CASCADE's linear deflection, as a part of the model's diagonal")
      ->check(CLI::Range(1e-9, 1.0))
      ->type_name("D")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace dupin::app
