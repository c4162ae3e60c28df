// Reads a file beside the window, and hands over its parts as they get ready.
#ifndef DUPIN_APP_VIEWER_LOADER_H
#define DUPIN_APP_VIEWER_LOADER_H

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "../../host/prepared_model.h"

namespace dupin::app {

struct LoaderCallbacks {  ///< called on the loader's thread
  std::function<void(std::string stage, double fraction)> progress;
  std::function<void(std::shared_ptr<const PreparedModel>)>
      ready;  ///< some of the parts, with their placements
  std::function<void(Status)> done;
};

struct LoaderOptions {
  std::string units = "mm";
  double deflection = 0;  ///< > 0: triangles at this part of the diagonal, in place of exact faces
};

class Loader {
 public:
  Loader(std::string path, LoaderOptions options, LoaderCallbacks callbacks);
  ~Loader();  ///< stops, and waits
  void cancel() { cancelled_ = true; }

 private:
  void run();
  Status load();
  Progress progress();

  std::string path_;
  LoaderOptions options_;
  LoaderCallbacks callbacks_;
  std::atomic<bool> cancelled_{false};
  double done_ = 0, share_ = 1;  ///< of the faces: before the pieces that are prepared now, and of these
  std::thread thread_;
};

/// A model in pieces of whole parts with their placements, in the model's order: a small one first, so that
/// something is seen soon, each of the others about twice as many faces as the one before.
std::vector<Model> pieces_of(Model model);

}  // namespace dupin::app

#endif
