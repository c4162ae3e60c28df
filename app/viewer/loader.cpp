#include "loader.h"

#include <algorithm>
#include <chrono>

#include "../../cad_import/cad_import.h"

namespace dupin::app {
namespace {

constexpr std::size_t kFirstFaces = 400;
constexpr std::chrono::milliseconds kFirstPause{200};

/// Its meshes are drawn, and nothing else.
std::shared_ptr<const PreparedModel> as_triangles(Model model) {
  auto prepared = std::make_shared<PreparedModel>();
  prepared->dps.parts.resize(model.parts.size());
  prepared->trees.resize(model.parts.size());
  prepared->model = std::make_shared<Model>(std::move(model));
  return prepared;
}

/// Hands pieces over at once where the last is long ago, and else together: each time all that is shown is
/// uploaded anew, so that the pauses grow.
class Handover {
 public:
  explicit Handover(const LoaderCallbacks& callbacks) : callbacks_(callbacks) {}
  ~Handover() { flush(); }  // what was ready when loading stopped is shown
  void add(std::shared_ptr<const PreparedModel> piece) {
    waiting_.push_back(std::move(piece));
    if (Clock::now() >= next_) flush();
  }

 private:
  using Clock = std::chrono::steady_clock;
  void flush() {
    if (waiting_.empty()) return;
    callbacks_.ready(waiting_.size() == 1 ? waiting_[0] : std::make_shared<PreparedModel>(joined(waiting_)));
    waiting_.clear();
    next_ = Clock::now() + pause_;
    pause_ *= 2;
  }

  const LoaderCallbacks& callbacks_;
  std::vector<std::shared_ptr<const PreparedModel>> waiting_;
  Clock::time_point next_ = Clock::time_point::min();
  std::chrono::milliseconds pause_ = kFirstPause;
};

}  // namespace

std::vector<Model> pieces_of(Model model) {
  std::vector<std::size_t> piece_of(model.parts.size());
  std::vector<std::uint32_t> number_in_piece(model.parts.size());
  std::vector<Model> pieces(1);
  std::size_t faces = 0, most = kFirstFaces;
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    if (faces >= most) pieces.emplace_back(), faces = 0, most *= 2;
    faces += face_count(model.parts[i]);
    piece_of[i] = pieces.size() - 1;
    number_in_piece[i] = static_cast<std::uint32_t>(pieces.back().parts.size());
    pieces.back().parts.push_back(std::move(model.parts[i]));
  }
  for (Instance& instance : model.instances) {
    const std::uint32_t part = instance.part;
    instance.part = number_in_piece[part];
    pieces[piece_of[part]].instances.push_back(std::move(instance));
  }
  for (Model& piece : pieces)
    piece.source = model.source, piece.format = model.format, piece.unit_note = model.unit_note;
  pieces[0].skipped = std::move(model.skipped);
  pieces[0].notes = std::move(model.notes);
  return pieces;
}

Loader::Loader(std::string path, LoaderOptions options, LoaderCallbacks callbacks)
    : path_(std::move(path)), options_(std::move(options)), callbacks_(std::move(callbacks)) {
  thread_ = std::thread([this] { run(); });
}

Loader::~Loader() {
  cancelled_ = true;
  thread_.join();
}

void Loader::run() {
  Status status;
  try {
    status = load();
  } catch (const std::exception& error) {
    status = {StatusCode::limit, path_ + ": " + error.what()};
  }
  callbacks_.done(status);
}

Progress Loader::progress() {
  return [this](std::string_view stage, double fraction) {
    callbacks_.progress(std::string(stage), done_ + share_ * fraction);
    return !cancelled_;
  };
}

Status Loader::load() {
  ImportOptions import;
  import.assumed_unit = options_.units;
  import.mesh_deflection = options_.deflection;
  import.progress = progress();
  auto model = import_cad(path_, import);
  if (!model) return model.status();
  const std::size_t faces = std::max<std::size_t>(1, face_instance_count(*model));
  if (face_instance_count(*model) == 0) return {StatusCode::unreadable, path_ + ": holds nothing to draw"};
  PrepareOptions prepare_options;
  prepare_options.tolerance = kDefaultTolerance * bounding_box(*model).diagonal();
  prepare_options.progress = progress();
  done_ = 0;
  Handover handover(callbacks_);
  for (Model& piece : pieces_of(std::move(*model))) {
    share_ = static_cast<double>(face_instance_count(piece)) / static_cast<double>(faces);
    if (cancelled_) return {StatusCode::cancelled, path_ + ": stopped"};
    if (options_.deflection > 0) {
      handover.add(as_triangles(std::move(piece)));
    } else {
      auto prepared = prepare(std::make_shared<Model>(std::move(piece)), prepare_options);
      if (!prepared) return prepared.status();
      handover.add(std::move(*prepared));
    }
    done_ += share_;
  }
  return {};
}

}  // namespace dupin::app
