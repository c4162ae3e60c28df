// A study: rows of models × views × sizes × options of `dupin render`, each to be measured against a
// reference. docs/studies.md is the manual of study files.
#ifndef DUPIN_APP_STUDY_STUDY_H
#define DUPIN_APP_STUDY_STUDY_H

#include <string>
#include <utility>
#include <vector>

#include "../../core/status.h"
#include "../render_options.h"

namespace dupin::app {

struct StudyView {
  std::string name;  ///< of the row's column; unique in a study
  ViewOptions camera;
  /// > 1: that many times as near to the point of the surface that is seen nearest to the picture's middle;
  /// < 1: that much farther off.
  double zoom = 1;
};

/// What is in a model's file: by its name, and of trees by how it begins.
enum class ModelKind { cad, points, tree };

struct StudyModel {
  std::string name;  ///< as the study has it
  std::string path;
  int line = 0;    ///< of the study, for what is wrong with the file
  std::string of;  ///< the path of the model that points or a tree were made of; "": not told
  ModelKind kind() const;
  /// Where what its pictures are compared with comes from.
  const std::string& reference_path() const { return of.empty() ? path : of; }
  /// The same for rows that have their reference in common.
  std::string id() const { return path + "\n" + of; }
};

/// A key and its value, as `dupin render` takes them: {"tolerance", "0.5"}. A flag has the value "true".
using StudyOption = std::pair<std::string, std::string>;

struct StudyRow {
  std::size_t index = 0;
  StudyModel model;
  StudyView view;
  int width = 0, height = 0;
  std::vector<StudyOption> options;
  RenderOptions render;  ///< what they mean; its camera is the view's before the zoom
  /// The options that change how a picture looks but not what is drawn, which a reference shares.
  std::vector<StudyOption> looks;

  /// Points and trees are drawn as their files have them: nothing is made from faces.
  bool is_prepared() const;
  /// "--tolerance 0.5 …"
  std::string arguments() const;
  std::string value_of(const std::string& key) const;  ///< "" where it is not set
};

enum class ReferenceKind { exact, triangles, none };

struct Study {
  std::string title;
  ReferenceKind reference = ReferenceKind::exact;
  double reference_deflection = 1e-5;  ///< of ReferenceKind::triangles
  int frames = 5;                      ///< timed; 0: none
  int prepares = 1;
  bool draw = true;       ///< else preparation alone is measured
  bool pictures = false;  ///< kept, with difference pictures
  double row_seconds = 600;
  std::vector<std::string> keys;  ///< every option that a row sets, in the file's order
  std::vector<StudyRow> rows;     ///< in their final order
};

/// Reads a study; models that are folders stand for the CAD and mesh files in them. invalid_argument with
/// "FILE:LINE: reason" for anything that cannot be meant: no work is begun with a study that has one wrong
/// row.
Result<Study> read_study(const std::string& path);
/// The same from memory; relative models are looked for in `folder`, and messages call it `name`.
Result<Study> parse_study(const std::string& text, const std::string& name, const std::string& folder);

/// The options of a row as RenderOptions; says what is wrong with them.
Status resolve_row(const Study& study, StudyRow& row);
/// "" for an option that a row may set; else why not.
std::string check_key(const std::string& key);

/// Files under a folder that `dupin` reads, by their names' endings, sorted.
std::vector<std::string> model_files(const std::string& folder);

/// Row indices of shard `number` (1-based) of `count`: contiguous, so that rows of a model stay together.
std::pair<std::size_t, std::size_t> shard_range(std::size_t rows, int number, int count);

}  // namespace dupin::app

#endif
