// What a support function alone tells of a convex set, by libccd's Minkowski portal refinement (MPR).
//
// Let h(d) = s(d) . d be the support along the unit vector d. The depth of a point p inside is the least of
// f(d) = h(d) - p . d over all d, and f(d) is never less than it, whatever d. MPR answers another question: it starts
// with a center in the set and gives the normal n of the face where the ray from the center through p leaves. With the
// center behind p, at p - b d, that is the normal where the ray from p along d leaves. If the way out is t(d), then
//     t(d) >= f(n) >= t(n) >= f(n') ...
// since the plane with the normal n holds the set back along d at t(d) and is f(n) away from p, and the set ends before
// it does: taking n for the next d never loses, and ends where n = d, which is a place where the surface is as near as
// nowhere close by. Near the surface this takes a few turns: the error shrinks by depth over radius of curvature.
// Such places may be several (a box has six). So the set is sampled at set-up along directions all round, and each
// direction whose f is least among its neighbours' is a start, but for those that cannot beat the best one any more.
// Flat sets have their directions crowded where they are flat. The samples also turn away most points outside.
//
// Outside, the distance is that by which p lies inside the set grown by r, less than r. With r a little more than the
// distance the same descent answers it, from one start, since outside there is one nearest place.
//
// libccd compares lengths with fixed numbers, so each question is put to it in units of the way out. Its search for a
// first portal may go on for ever when the center is close to the surface; so the center is put midway to the other
// side of the set, and after kMaxCalls its search is ended by points that no set has. Its MPR does not allocate, unlike
// its GJK (which, in metres, was also wrong by a factor of 36).
#include "crumble/geometry/support_solid.hpp"

#include <ccd/ccd.h>

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "geometry/solid_bytes.hpp"
#include "geometry/support_samples.hpp"

namespace crumble {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTolerance = 1e-11;   // of MPR, of the set's size
constexpr double kTouch = 1e-13;       // of the size: nothing is asked for points nearer to the surface
constexpr double kSamePlace = 2.5e-3;  // squared distance of directions
constexpr int kOrigin = 0;             // something to point to: libccd's other body has nothing to know
constexpr int kMaxTurns = 60;
constexpr int kMaxCalls = 400;  // of the function in one MPR, which has no bound of its own everywhere

class SupportModel final : public SolidModel {
 public:
  SupportModel(const SupportFunction& function, const Vec3& inside);

  bool find_inside(const Vec3& p, std::uint32_t& hint, SolidPoint& nearest) const noexcept override {
    const std::size_t likely = hint < samples_.directions.size() ? hint : 0;
    if (dot(p, samples_.directions[likely]) - samples_.heights[likely] >= 0) return false;
    if (!(samples_.greatest_above(p, hint) < 0)) return false;  // nor what is not a number
    Way out;
    if (!is_in(p) || !way_out(p, out)) return false;
    nearest = {p + out.length * out.normal, out.normal, -out.length};
    return true;
  }

  SolidPoint nearest(const Vec3& p, double far) const noexcept override;
  bool leave_along(const Vec3& p, const Vec3& direction, SolidPoint& out) const noexcept override;

  // As much as tells it from others.
  void write(ByteWriter& out) const override {
    out.put(static_cast<std::uint8_t>(SolidKind::support));
    out.put(static_cast<std::uint64_t>(samples_.points.size()));
    for (const Vec3& point : samples_.points) put_vector(out, point);
  }

 private:
  struct Way {
    Vec3 normal = Vec3::UnitY();
    double length = 0;  // to the plane that holds the set back along the normal, metres
  };
  struct Question;  // to libccd

  Way plane_along(const Vec3& normal, const Vec3& p, double grown) const noexcept {
    return {normal, dot(samples_.support(normal) - p, normal) + grown};
  }
  bool is_in(const Vec3& p) const noexcept;
  struct Ray {
    double length;     // about how far it goes, metres
    double behind;     // how far on the other side of p the center is, metres
    double grown;      // by how much the set is, metres
    double tolerance;  // of the portal's place, in multiples of the length
  };
  bool normal_along(const Vec3& p, const Vec3& direction, const Ray& ray, Vec3& normal) const noexcept;
  void descend(const Vec3& p, const Way& best, Way& way) const noexcept;
  bool way_out(const Vec3& p, Way& best) const noexcept;
  SolidPoint nearest_outside(const Vec3& p, std::uint32_t sample) const noexcept;

  SupportSamples samples_;
  double size_;  // diagonal of the box, metres
  Vec3 inside_;
};

// The set as MPR is to see it: p is the origin, lengths are multiples of `unit`.
struct SupportModel::Question {
  const SupportModel* solid;
  Vec3 p, center;
  double unit, grown, tolerance;
  mutable Vec3 last_direction = Vec3::UnitY();
  mutable int calls = 0;

  static void ask(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
    const auto& q = *static_cast<const Question*>(object);
    Vec3 d(direction->v[0], direction->v[1], direction->v[2]);
    const double length = norm(d);
    d = length > 0 && std::isfinite(length) ? Vec3(d / length) : Vec3(Vec3::UnitY());
    q.last_direction = d;
    // behind the origin: every loop of MPR ends there
    const Vec3 point =
        ++q.calls > kMaxCalls ? Vec3(-d) : Vec3((q.solid->samples_.support(d) - q.p + q.grown * d) / q.unit);
    ccdVec3Set(out, point.x(), point.y(), point.z());
  }
  static void ask_center(const void* object, ccd_vec3_t* out) {
    const Vec3& c = static_cast<const Question*>(object)->center;
    ccdVec3Set(out, c.x(), c.y(), c.z());
  }
  static void origin_along(const void*, const ccd_vec3_t*, ccd_vec3_t* out) { ccdVec3Set(out, 0, 0, 0); }
  static void origin(const void*, ccd_vec3_t* out) { ccdVec3Set(out, 0, 0, 0); }

  ccd_t rules() const {
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ask, ccd.support2 = origin_along;
    ccd.center1 = ask_center, ccd.center2 = origin;
    ccd.max_iterations = 100;
    ccd.mpr_tolerance = tolerance;
    return ccd;
  }
};

bool SupportModel::is_in(const Vec3& p) const noexcept {
  const Question question{this, p, (inside_ - p) / size_, size_, 0, kTolerance};
  const ccd_t ccd = question.rules();
  return ccdMPRIntersect(&question, &kOrigin, &ccd) != 0;
}

// Normal of the grown set where the ray from p leaves it, when the center is in the set. libccd tells only the nearest
// point of its last portal, a triangle with this normal; the direction in which it asked last is the normal.
bool SupportModel::normal_along(const Vec3& p, const Vec3& direction, const Ray& ray, Vec3& normal) const noexcept {
  const Question question{this, p, -ray.behind / ray.length * direction, ray.length, ray.grown, ray.tolerance};
  const ccd_t ccd = question.rules();
  ccd_real_t depth = 0;
  ccd_vec3_t way{}, place{};
  const bool is_found = ccdMPRPenetration(&question, &kOrigin, &ccd, &depth, &way, &place) == 0;
  normal = question.last_direction;
  return is_found && question.calls <= kMaxCalls;
}

// From way.normal to a place where the surface is as near as nowhere close by, unless it comes to where `best` is. The
// first turns need no exact normals.
void SupportModel::descend(const Vec3& p, const Way& best, Way& way) const noexcept {
  double behind = 0.5 * samples_.way_along(p, -way.normal, 0), tolerance = 0.1;
  const double least_behind = 0.1 * behind;
  for (int turn = 0; turn < kMaxTurns && way.length > kTouch * size_; ++turn) {
    const double fine = kTolerance * size_ / way.length;
    tolerance = std::max(tolerance, fine);
    Vec3 normal;
    const bool is_found = normal_along(p, way.normal, {way.length, behind, 0, tolerance}, normal);
    if (is_found && squared_norm(normal - way.normal) < 1e-28) return;
    Way next = is_found ? plane_along(normal, p, 0) : way;
    if (next.length < way.length) {
      const Vec3 turned = next.normal - way.normal;
      for (double more = 1; more < 1e6; more *= 2) {  // as far on as that helps: deep points turn slowly
        const Way farther = plane_along(normalized(normal + more * turned), p, 0);
        if (!(farther.length < next.length)) break;
        next = farther;
      }
      const bool is_settled = tolerance == fine && way.length - next.length < kTolerance * size_;
      way = next;
      if (is_settled || (way.length >= best.length && squared_norm(way.normal - best.normal) < kSamePlace)) return;
      tolerance *= 1e-4;
    } else if (tolerance > fine) {
      tolerance *= 1e-4;
    } else if (behind < least_behind) {
      return;
    } else {
      behind *= 0.3;  // the point behind may have been outside
    }
  }
}

// As f(d) >= (s_i - p) . d for each sample, f is at least f_i less the sideways part of s_i - p times the distance of
// d from d_i: what cannot beat the best is no start.
bool SupportModel::way_out(const Vec3& p, Way& best) const noexcept {
  best.length = kInfinity;
  std::uint32_t least = 0;
  samples_.greatest_above(p, least);
  const auto length_of = [&](std::size_t i) { return samples_.heights[i] - dot(p, samples_.directions[i]); };
  const auto try_from = [&](std::size_t i) {
    Way way{samples_.directions[i], length_of(i)};
    descend(p, best, way);
    if (way.length < best.length) best = way;
  };
  try_from(least);
  for (std::size_t i = 0; i < samples_.directions.size(); ++i) {
    const double length = length_of(i);
    const double behind_best = length - best.length;
    const double squared_sideways = squared_norm(samples_.points[i] - p) - length * length;
    if (i == least || (behind_best > 0 && behind_best * behind_best >= samples_.squared_reach[i] * squared_sideways))
      continue;
    const bool is_start = std::none_of(samples_.neighbours[i].begin(), samples_.neighbours[i].end(),
                                       [&](std::uint32_t k) { return length_of(k) < length; });
    if (is_start) try_from(i);
  }
  return best.length > 0;
}

SolidPoint SupportModel::nearest(const Vec3& p, double far) const noexcept {
  std::uint32_t sample = 0;
  const double above = samples_.greatest_above(p, sample);
  if (!(above <= far)) return {p, samples_.directions[sample], above};
  Way out;
  if (above < 0 && is_in(p) && way_out(p, out)) return {p + out.length * out.normal, out.normal, -out.length};
  return nearest_outside(p, sample);
}

SolidPoint SupportModel::nearest_outside(const Vec3& p, std::uint32_t sample) const noexcept {
  double farthest = kInfinity;  // upper bound of the distance
  for (const Vec3& point : samples_.points) farthest = std::min(farthest, norm(p - point));
  Way way{samples_.directions[sample], 0};
  double distance = 0;
  for (int turn = 0; turn < kMaxTurns; ++turn) {
    const double grown = 1.001 * farthest + 1e-6 * size_;
    way.length = dot(samples_.support(way.normal) - p, way.normal) + grown;
    distance = grown - way.length;
    Vec3 normal;
    const double behind = 0.5 * samples_.way_along(p, -way.normal, grown);
    if (!normal_along(p, way.normal, {way.length, behind, grown, kTolerance * size_ / way.length}, normal)) break;
    const Way next = plane_along(normal, p, grown);
    // where the ray leaves, less the growth: a point of the set
    const double exit = next.length / std::max(dot(normal, way.normal), 1e-3);
    farthest = std::min(farthest, norm(exit * way.normal - grown * normal));
    if (!(grown - next.length > distance)) break;
    const bool is_settled = grown - next.length - distance < kTolerance * size_;
    way = next;
    distance = grown - next.length;
    if (is_settled) break;
  }
  return {p - distance * way.normal, way.normal, distance};
}

// By halving, since a ray may run along the surface, where there is no point deep behind p to start a portal from. The
// normal is that of the surface nearest to a point just before the way out.
bool SupportModel::leave_along(const Vec3& p, const Vec3& direction, SolidPoint& out) const noexcept {
  if (!is_in(p)) return false;
  double inside = 0, outside = samples_.way_along(p, direction, 0);
  if (!std::isfinite(outside)) return false;  // no direction
  while (outside - inside > 1e-12 * size_) {
    const double middle = 0.5 * (inside + outside);
    (is_in(p + middle * direction) ? inside : outside) = middle;
  }
  Way way;
  if (!way_out(p + std::max(inside - 1e-7 * size_, 0.0) * direction, way)) return false;
  out = {p + inside * direction, way.normal, -inside};
  return true;
}

SupportModel::SupportModel(const SupportFunction& function, const Vec3& inside)
    : samples_(function, inside), size_(samples_.size()), inside_(inside) {
  set_corners(samples_.box_corners());
  surface_ = samples_.make_surface();
  Vec3 middle = Vec3::Zero();
  for (const Vec3& point : samples_.points) middle += point / static_cast<double>(samples_.points.size());
  Way out;
  for (const Vec3& center : {inside_, middle}) {
    if (is_in(center) && way_out(center, out)) half_thickness_ = std::max(half_thickness_, out.length);
  }
  if (!(half_thickness_ > 0)) throw Error(Code::out_of_range, "tool.inside does not lie inside the set");
}

}  // namespace

Solid make_support_solid(const SupportFunction& support, const Vec3& inside) {
  if (!support.support) throw Error(Code::null, "tool.support.support is null");
  require_finite("tool.inside.x", inside.x());
  require_finite("tool.inside.y", inside.y());
  require_finite("tool.inside.z", inside.z());
  return Solid(share_new<SupportModel>(support, inside));
}

}  // namespace crumble
