// Differential points as files: PLY, CSV and .dps.
#ifndef DUPIN_APP_POINT_FILES_H
#define DUPIN_APP_POINT_FILES_H

#include <string>

#include "../sampling/differential_point.h"
#include "../simplify/dps_file.h"

namespace dupin::app {

/// Every placement's points, in model space, with the numbers that `--aov face` has: x,y,z nx,ny,nz
/// d1x,d1y,d1z k1,k2 u,v face hu,hv bound. PLY is little-endian, doubles.
Status write_points_csv(const std::string& path, const Model& model, const PointScene& scene);
Status write_points_ply(const std::string& path, const Model& model, const PointScene& scene);
/// Points of one colour stand together.
Status write_points_dps(const std::string& path, const Model& model, const PointScene& scene,
                        DpsEncoding encoding);

}  // namespace dupin::app

#endif
