// A displacement that follows the place of the touch in one plane of the machine.
//
//   d = sum over the nodes i, j of w_i(s) w_j(t) ((x_ij, y_ij, z_ij) + r_ij n)
//
// s, t: the two coordinates of the plane from 0 to 1 between `from` and `to`; w: linear interpolation between kMapNodes
// evenly spaced nodes on each, constant beyond the ends. Linear in all nodes.
#include <algorithm>
#include <array>

#include "engine/effects/empirical/empirical.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr std::string_view kPlanes[] = {"xy", "xz", "yz"};
constexpr int kFirst[] = {0, 0, 1}, kSecond[] = {1, 2, 2};  // axes of a plane
constexpr int kFirstNode = 5, kOfNode = 4, kNodes = kMapNodes * kMapNodes;

/// "x_0_5_um": of the node 0 along the first coordinate and 5 along the second.
struct NodeName {
  static_assert(kMapNodes <= 10);
  char text[8]{};
  constexpr NodeName() = default;
  constexpr NodeName(int of_node, int i, int j)
      : text{"xyzr"[of_node], '_', static_cast<char>('0' + i), '_', static_cast<char>('0' + j), '_', 'u', 'm'} {}
  constexpr std::string_view name() const { return {text, sizeof text}; }
};

constexpr auto kNodeNames = [] {
  std::array<NodeName, kOfNode * kNodes> list{};
  for (int k = 0; k < kOfNode * kNodes; ++k)
    list[static_cast<std::size_t>(k)] = NodeName(k % kOfNode, k / kOfNode / kMapNodes, k / kOfNode % kMapNodes);
  return list;
}();

constexpr EffectParameter end(std::string_view name, std::string_view help, double standard) {
  return {.name = name, .unit = "mm", .help = help, .low = -1e9, .high = 1e9, .standard = standard};
}

constexpr auto kEmpiricalMapParameters = [] {
  std::array<EffectParameter, kFirstNode + kOfNode * kNodes> list{};
  list[0] = {.name = "plane", .unit = "code", .help = "the two coordinates in W", .high = 2, .choices = kPlanes};
  list[1] = end("from_1", "the first coordinate of the first nodes", 0);
  list[2] = end("to_1", "the first coordinate of the last nodes", 1);
  list[3] = end("from_2", "the second coordinate of the first nodes", 0);
  list[4] = end("to_2", "the second coordinate of the last nodes", 1);
  for (int k = 0; k < kOfNode * kNodes; ++k) {
    const auto at = static_cast<std::size_t>(k);
    list[static_cast<std::size_t>(kFirstNode) + at] = {
        .name = kNodeNames[at].name(),
        .unit = "um",
        .help = "displacement at this node: x, y, z in W, r along the outward normal",
        .typical = 1,
        .low = -1e4,
        .high = 1e4,
        .linear = true};
  }
  return list;
}();

/// Where a coordinate lies among its nodes: after which, and by what share of the way to the next.
struct Among {
  int node = 0;
  double share = 0;
};
Among among(double at, double from, double to) {
  const double s = std::clamp((at - from) / (to - from), 0.0, 1.0) * (kMapNodes - 1);
  const int node = std::min(static_cast<int>(s), kMapNodes - 2);
  return {node, s - node};
}

Vec3 empirical_map(const TouchScene& scene, const double* theta, const double*) {
  if (theta[1] == theta[2] || theta[3] == theta[4]) return {};
  const int plane = code(theta[0]);
  const Among first = among(scene.point[kFirst[plane]], theta[1], theta[2]),
              second = among(scene.point[kSecond[plane]], theta[3], theta[4]);
  Vec3 d;
  double r = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double w = (i ? first.share : 1 - first.share) * (j ? second.share : 1 - second.share);
      const double* at = theta + kFirstNode + kOfNode * ((first.node + i) * kMapNodes + second.node + j);
      d += w * Vec3{at[0], at[1], at[2]};
      r += w * at[3];
    }
  return kUm * d + along_normal(scene, kUm * r);
}

bool beyond_empirical_map(const TouchScene& scene, const double* theta) {
  const int plane = code(theta[0]);
  return beyond_knots(scene.point[kFirst[plane]], theta[1], theta[2], kMapNodes) ||
      beyond_knots(scene.point[kSecond[plane]], theta[3], theta[4], kMapNodes);
}

std::string_view empirical_map_contradiction(const double* theta) {
  return theta[1] == theta[2] || theta[3] == theta[4]
      ? "a map needs two ends along each coordinate: from and to are the same"
      : "";
}

constexpr auto kNeighbouringNodes = [] {
  constexpr auto at = [](int i, int j, int of_node) {
    return static_cast<std::size_t>(kFirstNode + kOfNode * (i * kMapNodes + j) + of_node);
  };
  std::array<Neighbours, 2 * kOfNode * kMapNodes*(kMapNodes - 1)> list{};
  Neighbours* next = list.data();
  for (int i = 0; i < kMapNodes; ++i)
    for (int j = 0; j + 1 < kMapNodes; ++j)
      for (int k = 0; k < kOfNode; ++k) {
        *next++ = {at(i, j, k), at(i, j + 1, k)};
        *next++ = {at(j, i, k), at(j + 1, i, k)};
      }
  return list;
}();

}  // namespace

constinit const Effect kEmpiricalMap{
    .name = "empirical.map",
    .title = "empirical: a displacement over a plane of the machine",
    .help =
        "A map that a diagnosis has fitted to a mismatch which no effect of the catalogue explains: linear between its nodes in two of the machine's "
        "coordinates, the same at all places along the third, and constant beyond the range of the recording that it was fitted to.",
    .source = "none: a fit to a recording",
    .separate = "find the physics: what `abbe diagnose` proposes to measure next",
    .stage = Stage::structure,
    .needs = 0,
    .parameters = kEmpiricalMapParameters,
    .neighbours = kNeighbouringNodes,
    .contradiction = empirical_map_contradiction,
    .displace = empirical_map,
    .beyond = beyond_empirical_map,
};

}  // namespace abbe
