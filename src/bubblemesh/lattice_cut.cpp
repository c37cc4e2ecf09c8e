// Nodes near the side are taken by rising distance from it. One that still has a neighbour on the other side, which is
// itself not drawn onto the surface, is drawn onto it. This greedy vertex cover leaves no lattice edge that crosses the
// surface, and moves no node by more than half an edge. The cells whose nodes are all inside or on the surface are the
// body. Neighbours are neighbours on the lattice everywhere.
//
// A hole between six nodes, an octahedron, touches its neighbours by its faces only, so each may be cut along a
// diagonal of its own. The upright diagonal leads from a node to one with the same row and place two layers higher: in
// row order, a constant offset along a whole row, and both rows begin at the same x. All octahedra are cut along it,
// but for those near the surface where another one makes better tetrahedra.
#include "bubblemesh/lattice_cut.hpp"

#include <algorithm>
#include <limits>

#include "bubblemesh/measures.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr double kReach = 0.65;  // greatest distance of a node that is drawn onto the side, in d: half a stretched edge
constexpr double kGoodUpright = 0.5;  // least sine of the angles at which an octahedron keeps its upright diagonal
constexpr double kOnePiece = 0.3;     // cosine between normals on one face of the side
constexpr std::uint32_t kNone = 0xffffffffu;

enum class Where : std::uint8_t { outside, on_side, inside };

/// The sites between the body's first and last, with a margin outside on all sides.
class SiteTable {
 public:
  SiteTable(const Site& first, const Site& last)
      : first_{first.layer - 2, first.row - 2, first.place - 2},
        rows_(static_cast<std::size_t>(last.row - first.row + 5)),
        places_(static_cast<std::size_t>(last.place - first.place + 5)),
        where_(static_cast<std::size_t>(last.layer - first.layer + 5) * rows_ * places_, Where::outside) {}

  std::size_t index(const Site& s) const {
    return (static_cast<std::size_t>(s.layer - first_.layer) * rows_ + static_cast<std::size_t>(s.row - first_.row)) *
               places_ +
           static_cast<std::size_t>(s.place - first_.place);
  }
  Where& operator[](const Site& s) { return where_[index(s)]; }
  Where operator[](const Site& s) const { return where_[index(s)]; }
  std::size_t size() const { return where_.size(); }

 private:
  Site first_;
  std::size_t rows_, places_;
  Vector<Where> where_;
};

template <class Visit>
void for_each_site(const Site& first, const Site& last, Visit visit) {
  for (std::int32_t layer = first.layer; layer <= last.layer; ++layer) {
    for (std::int32_t row = first.row; row <= last.row; ++row) {
      for (std::int32_t place = first.place; place <= last.place; ++place) visit(Site{layer, row, place});
    }
  }
}

SiteTable draw_onto_side(const LatticeBody& body, double spacing) {
  struct Near {
    double distance;
    Site site;
  };
  Vector<Near> near;
  SiteTable table(body.first(), body.last());
  for_each_site(body.first(), body.last(), [&](const Site& s) {
    const Vec3 p = body.point(s);
    const double distance = body.side_distance(p);
    table[s] = body.is_at_crease(p) ? Where::on_side : distance < 0 ? Where::inside : Where::outside;
    if (table[s] != Where::on_side && std::abs(distance) <= kReach * spacing) near.push_back({std::abs(distance), s});
  });
  std::ranges::stable_sort(near, {}, &Near::distance);
  for (const Near& n : near) {
    const Where other = table[n.site] == Where::inside ? Where::outside : Where::inside;
    const bool crosses = std::ranges::any_of(nearest_neighbours(n.site), [&](const Site& s) {
      return s.layer >= body.first().layer && s.layer <= body.last().layer && table[s] == other;
    });
    if (crosses) table[n.site] = Where::on_side;
  }
  return table;
}

class CellCutter {
 public:
  CellCutter(const LatticeBody& body, const SiteTable& table)
      : body_(body), table_(table), nodes_(table.size(), kNone) {
    for_each_site(body.first(), body.last(), [&](const Site& s) {
      if (table[s] != Where::outside) add_node(s);
    });
  }

  LatticeCut cut() {
    for_each_site(body_.first(), body_.last(), [&](const Site& s) {
      add_tetrahedra(s);
      add_octahedron(s);
    });
    drop_unused_nodes();
    return std::move(result_);
  }

 private:
  void add_node(const Site& s) {
    const bool level = body_.is_level_face(s.layer);
    SidePlace place{body_.point(s), Vec3::Zero()};
    NodeKind kind = level ? NodeKind::surface : NodeKind::inside;
    if (level) place.normal.y() = s.layer == body_.last().layer ? 1 : -1;
    if (table_[s] == Where::on_side) {
      place = body_.side_place(place.point);
      kind = place.on_crease ? NodeKind::crease : NodeKind::surface;
      if (level) kind = place.on_crease ? NodeKind::corner : NodeKind::crease;
    }
    nodes_[table_.index(s)] = static_cast<std::uint32_t>(result_.sites.size());
    result_.sites.push_back(s);
    result_.cloud.add(place.point, kind, place.normal);
    on_side_.push_back(table_[s] == Where::on_side);
    on_crease_.push_back(place.on_crease);
  }
  std::uint32_t node(const Site& s) const { return nodes_[table_.index(s)]; }

  /// The two tetrahedra that begin at the site: its edge along x and its edge along z, each with the edge across above.
  void add_tetrahedra(const Site& s) {
    const std::int32_t above = s.layer + 1, row = s.row + parity(s.layer), place = s.place + parity(s.layer);
    add(oriented(
        {node(s), node({s.layer, s.row, s.place + 1}), node({above, row - 1, place}), node({above, row, place})}));
    add(oriented(
        {node(s), node({s.layer, s.row + 1, s.place}), node({above, row, place}), node({above, row, place - 1})}));
  }

  /// The octahedron around the square that begins at the site.
  void add_octahedron(const Site& s) {
    const std::int32_t row = s.row + parity(s.layer), place = s.place + parity(s.layer);
    const std::array<std::uint32_t, 4> square{node(s), node({s.layer, s.row, s.place + 1}),
                                              node({s.layer, s.row + 1, s.place + 1}),
                                              node({s.layer, s.row + 1, s.place})};
    const std::uint32_t below = node({s.layer - 1, row, place}), above = node({s.layer + 1, row, place});
    const Pieces upright = pieces(below, above, square);
    if (upright.worst >= kGoodUpright) return add_all(upright);
    const Pieces first = pieces(square[0], square[2], {below, square[1], above, square[3]});
    const Pieces second = pieces(square[1], square[3], {below, square[2], above, square[0]});
    const Pieces& level = second.worst > first.worst ? second : first;
    add_all(level.worst > upright.worst ? level : upright);
  }

  struct Pieces {
    std::array<Tetrahedron, 4> tets;
    std::size_t count = 0;
    double worst = -std::numeric_limits<double>::infinity();  // stays if the diagonal is not in the body
  };
  Pieces pieces(std::uint32_t a, std::uint32_t b, const std::array<std::uint32_t, 4>& around) const {
    Pieces result;
    if (a == kNone || b == kNone) return result;
    result.worst = 1;
    for (std::size_t k = 0; k < 4; ++k) {
      const Tetrahedron t = oriented({a, b, around[k], around[(k + 1) % 4]});
      if (!is_in_body(t)) continue;
      result.tets[result.count++] = t;
      result.worst = std::min(result.worst, quality(t));
    }
    return result;
  }

  /// With positive volume on the lattice. Its layers tell: a drawn node may have changed the sign.
  Tetrahedron oriented(Tetrahedron t) const {
    if (std::ranges::find(t, kNone) != t.end()) return t;
    const auto point = [&](std::uint32_t v) { return body_.lattice().point(result_.sites[v]); };
    if (orient(point(t[0]), point(t[1]), point(t[2]), point(t[3])) < 0) std::swap(t[2], t[3]);
    return t;
  }
  double quality(const Tetrahedron& t) const {
    const auto& p = result_.cloud.positions;
    return least_sine(p[t[0]], p[t[1]], p[t[2]], p[t[3]]);
  }

  /// Four nodes on one smooth piece of the side enclose nothing but the sagitta between it and its faces.
  bool is_in_body(const Tetrahedron& t) const {
    if (std::ranges::find(t, kNone) != t.end()) return false;
    if (!std::ranges::all_of(t, [&](std::uint32_t v) { return on_side_[v]; })) return true;
    if (!body_.has_upright_creases()) return false;
    for (const std::uint32_t v : t) {
      for (const std::uint32_t w : t) {
        if (on_crease_[v] || on_crease_[w]) continue;
        if (dot(result_.cloud.normals[v], result_.cloud.normals[w]) < kOnePiece) return true;
      }
    }
    return false;
  }
  void add(const Tetrahedron& t) {
    if (is_in_body(t)) result_.tetrahedra.push_back(t);
  }
  void add_all(const Pieces& pieces) {
    result_.tetrahedra.insert(result_.tetrahedra.end(), pieces.tets.begin(), pieces.tets.begin() + pieces.count);
  }

  void drop_unused_nodes() {
    Vector<char> used(result_.sites.size(), 0);
    for (const Tetrahedron& t : result_.tetrahedra) {
      for (const std::uint32_t v : t) used[v] = 1;
    }
    Vector<std::uint32_t> new_index(used.size(), kNone);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      result_.sites[count] = result_.sites[i];
      new_index[i] = count++;
    }
    result_.sites.resize(count);
    result_.cloud.select(used);
    for (Tetrahedron& t : result_.tetrahedra) {
      for (std::uint32_t& v : t) v = new_index[v];
    }
  }

  const LatticeBody& body_;
  const SiteTable& table_;
  Vector<std::uint32_t> nodes_;  // of each site
  Vector<char> on_side_, on_crease_;
  LatticeCut result_;
};

}  // namespace

LatticeCut cut_lattice(const LatticeBody& body, double spacing) {
  const SiteTable table = draw_onto_side(body, spacing);
  return CellCutter(body, table).cut();
}

}  // namespace crumble
