// What is inside the body as tables for other programs: springs, tetrahedra, fragments.
#pragma once

#include <nlohmann/json.hpp>

#include "crumble/sim/simulation.hpp"
#include "render/vtk_xml.hpp"

namespace crumble::app {

/// Springs as lines, whole and cut ones, with `spring`, `intact`, `stretch` (length / rest length) and `fragment` (-1:
/// its ends are in two); nodes with `velocity` and `fragment`.
render::VtkGrid spring_grid(const Simulation& sim);

/// Tetrahedra with `cut_mask` and `fragment` (-1: it lies in several); nodes with `kind`, `rest` and `fragment`.
render::VtkGrid body_grid(const Simulation& sim);
/// At rest and whole: tetrahedra; nodes with `kind`.
render::VtkGrid body_grid(const TetMesh& mesh);

/// One point for each fragment that is there, at its center of mass.
render::VtkGrid fragment_grid(const Simulation& sim);
nlohmann::ordered_json fragment_json(const Simulation& sim);

}  // namespace crumble::app
