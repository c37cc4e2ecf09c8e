#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "crumble/base/clock.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/bubblemesh/presets.hpp"
#include "crumble/tetmesh/vtk_file.hpp"
#include "grids.hpp"
#include "output.hpp"
#include "render/mesh_file.hpp"

namespace crumble::app {
namespace {

struct MeshOptions {
  std::string shape, out, lattice = "hcp", structure = "relaxed";
  Vector<double> sizes, offset;
  std::optional<double> spacing;
  std::optional<std::uint32_t> surface_nodes, inside_nodes;
  bool json = false;
};

// The sizes, named as in the usage; as many as there are names.
Vector<double> sizes(const MeshOptions& options, const Vector<std::string>& names) {
  if (options.sizes.size() != names.size()) {
    std::string usage;
    for (const std::string& name : names) usage += " " + name;
    throw Error(Code::format, "mesh " + options.shape + " takes" + (usage.empty() ? " no sizes" : usage + ", metres") +
                                  ", not " + std::to_string(options.sizes.size()) + " of them");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    require_positive("mesh " + options.shape + " " + names[i], options.sizes[i]);
  }
  return options.sizes;
}

std::unique_ptr<Shape> make_shape(const MeshOptions& options) {
  if (options.shape == "box") {
    const auto size = sizes(options, {"X", "Y", "Z"});
    return make_box({size[0], size[1], size[2]});
  }
  if (options.shape == "sphere") return make_sphere(sizes(options, {"RADIUS"})[0]);
  if (options.shape == "cylinder") {
    const auto size = sizes(options, {"RADIUS", "HEIGHT"});
    return make_cylinder(size[0], size[1]);
  }
  for (const PaperBody body : {PaperBody::cube, PaperBody::slab, PaperBody::globe, PaperBody::globe_literal}) {
    if (options.shape != paper_body_facts(body).name) continue;
    sizes(options, {});
    return make_paper_shape(body);
  }
  throw Error(Code::unsupported, "mesh '" + options.shape +
                                     "' is not known; there are: box sphere cylinder cube slab globe globe_literal");
}

BubbleMeshOptions bubble_options(const MeshOptions& options) {
  BubbleMeshOptions bubble;
  for (const PaperBody body : {PaperBody::cube, PaperBody::slab, PaperBody::globe, PaperBody::globe_literal}) {
    if (options.shape == paper_body_facts(body).name) bubble = paper_options(body);
  }
  if (options.spacing) bubble.spacing = *options.spacing;
  if (!options.spacing && bubble.spacing == 0) throw Error(Code::format, "--spacing is missing, metres");
  require_positive("--spacing", bubble.spacing);
  if (options.offset.size() == 3) bubble.offset = {options.offset[0], options.offset[1], options.offset[2]};
  if (options.lattice != "hcp" && options.lattice != "fcc") {
    throw Error(Code::unsupported, "--lattice '" + options.lattice + "' is not known; there are: hcp fcc");
  }
  if (options.lattice == "fcc") bubble.lattice = Lattice::fcc;
  if (options.structure != "relaxed" && options.structure != "lattice") {
    throw Error(Code::unsupported, "--structure '" + options.structure + "' is not known; there are: relaxed lattice");
  }
  if (options.structure == "lattice") {
    bubble.structure = Structure::lattice;
    bubble.surface_nodes = bubble.inside_nodes = std::nullopt;  // the paper's numbers are of the relaxed structure
  }
  if (options.surface_nodes) bubble.surface_nodes = options.surface_nodes;
  if (options.inside_nodes) bubble.inside_nodes = options.inside_nodes;
  return bubble;
}

void write_mesh(const TetMesh& mesh, const std::filesystem::path& path) {
  if (path.extension() == ".vtk") return write_vtk(mesh, path);
  if (path.extension() == ".vtu") return write_text(path, to_vtu(body_grid(mesh)));
  render::Surface surface;
  surface.mesh.positions = mesh.positions;
  surface.mesh.triangles = mesh.boundary;
  render::write_mesh_file(surface, path);
}

double share(const Vector<std::uint8_t>& flags) {
  return static_cast<double>(std::ranges::count(flags, 1)) / static_cast<double>(flags.size());
}

nlohmann::ordered_json to_json(const BubbleMesh& body, const std::string& structure, double seconds) {
  const TetMesh& mesh = body.mesh;
  const MeshQuality& q = body.quality;
  return {{"structure", structure},
          {"rows", body.rows.size()},
          {"lattice_neighbour_share", share(body.lattice_neighbours)},
          {"share_in_runs_of_4", share_in_runs(mesh, 4)},
          {"nodes", mesh.node_count()},
          {"surface_nodes", mesh.surface_node_count()},
          {"springs", mesh.springs.size()},
          {"tetrahedra", mesh.tetrahedra.size()},
          {"dihedral_min_degrees", q.dihedral_min},
          {"dihedral_max_degrees", q.dihedral_max},
          {"slivers", q.slivers},
          {"volume_length_min", q.volume_length_min},
          {"volume_length_mean", q.volume_length_mean},
          {"edge_min_m", q.edge_min},
          {"edge_mean_m", q.edge_mean},
          {"edge_max_m", q.edge_max},
          {"edge_variation", q.edge_variation},
          {"euler_defect", q.euler_defect},
          {"boundary_defects", q.boundary_defects.total()},
          {"volume_m3", volume(mesh)},
          {"volume_error", body.volume_error},
          {"cpu_s", seconds},
          {"warnings", body.warnings}};
}

void mesh(const MeshOptions& options) {
  const std::filesystem::path out = options.out;
  if (!out.empty()) require_extension(out, ".vtk " + render::mesh_file_extensions());
  const std::unique_ptr<Shape> shape = make_shape(options);
  const double before = thread_cpu_seconds();
  const BubbleMesh body = generate(*shape, bubble_options(options));
  const double seconds = thread_cpu_seconds() - before;
  if (!out.empty()) write_mesh(body.mesh, out);
  const nlohmann::ordered_json json = to_json(body, options.structure, seconds);
  if (options.json) {
    std::puts(json.dump(1).c_str());
  } else {
    for (const auto& [key, value] : json.items()) std::printf("%-24s %s\n", key.c_str(), value.dump().c_str());
  }
}

}  // namespace

void add_mesh(CLI::App& app) {
  auto* command = app.add_subcommand("mesh", "Mesh a shape by close-packed bubbles and report its quality");
  auto options = std::make_shared<MeshOptions>();
  command
      ->add_option(
          "shape", options->shape,
          "box X Y Z, sphere RADIUS, cylinder RADIUS HEIGHT (metres), or the paper's cube, slab, globe, globe_literal")
      ->required();
  command->add_option("sizes", options->sizes, "Sizes of the shape, metres");
  command->add_option("--spacing", options->spacing, "Distance between neighbouring nodes, metres");
  command->add_option("--surface-nodes", options->surface_nodes, "Exact number of nodes on the surface");
  command->add_option("--inside-nodes", options->inside_nodes, "Exact number of nodes inside");
  command->add_option("--lattice", options->lattice, "hcp or fcc, of the relaxed structure")->capture_default_str();
  command
      ->add_option("--structure", options->structure,
                   "relaxed: even distances near the surface; lattice: lattice neighbours everywhere, the fastest")
      ->capture_default_str();
  command->add_option("--offset", options->offset, "Shift of the lattice, in spacings")->expected(3);
  command->add_option("--out", options->out, "Mesh as .vtk .vtu, or its surface as .glb .obj .ply .stl");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([options] { mesh(*options); });
}

}  // namespace crumble::app
