// The numbers of a row, in the order of the tables.
#include "measure.h"

namespace dupin::app {

const std::vector<std::string>& result_columns() {
  static const std::vector<std::string> names{"faces",
                                              "faces_skipped",
                                              "primitives",
                                              "bytes",
                                              "clips",
                                              "points_before",
                                              "points",
                                              "packed_bytes",
                                              "bound",
                                              "bound_px",
                                              "normal_bound_degrees",
                                              "covered_px",
                                              "reference_covered_px",
                                              "rmse",
                                              "rmse_covered",
                                              "psnr",
                                              "ssim",
                                              "flip",
                                              "silhouette_px",
                                              "outline_p99_px",
                                              "outline_max_px",
                                              "holes_px",
                                              "extra_px",
                                              "depth_p50_px",
                                              "depth_p99_px",
                                              "depth_max_px",
                                              "normal_p50_degrees",
                                              "normal_p99_degrees",
                                              "normal_max_degrees",
                                              "agreeing_px",
                                              "agreeing_color_p99",
                                              "agreeing_color_max"};
  return names;
}

const std::vector<std::string>& time_columns() {
  static const std::vector<std::string> names{
      "import_s", "prepare_s", "prepare_least_s", "prepare_most_s", "prepare_cpu_s", "sample_s", "simplify_s",
      "upload_s", "frame_ms",  "frame_p10_ms",    "frame_p90_ms",   "frame_cpu_ms",  "frames"};
  return names;
}

}  // namespace dupin::app
