// Standard views: cameras that show the whole of a box from one side, as CAD programs do (Z up).
#ifndef DUPIN_RENDER_VIEW_H
#define DUPIN_RENDER_VIEW_H

#include <string_view>

#include "../core/camera.h"
#include "../core/status.h"

namespace dupin {

/// The names: iso front back left right top bottom. Front looks along +Y, right along -X, top down; iso
/// stands at (1, -1, 1).
inline constexpr std::string_view kViewNames[] = {"iso", "front", "back", "left", "right", "top", "bottom"};

/// Part of the picture's width or height that stays free beside the fitted box, on both sides together.
inline constexpr double kFitMargin = 0.05;

/// The camera from the named side, placed so that the box just fills the picture but for the margin.
/// Projection, field of view and resolution are those of `settings`; a parallel camera gets its ortho_height.
/// An empty box is taken for a unit cube about the origin and a point for a cube of one unit about it.
/// invalid_argument for an unknown name.
Result<Camera> fit_view(const Box3& box, std::string_view name, const Camera& settings);

}  // namespace dupin

#endif
