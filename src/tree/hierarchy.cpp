#include "odds/tree/hierarchy.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

#include "odds/math/elementary.hpp"
#include "odds/math/rounding.hpp"

namespace odds::tree {
namespace {

constexpr std::size_t parallel_part = 16384;  // triangles that are worth a thread for something short

// Sums over triangles that a node's statistics are made from; they add up the tree.
struct Moments {
  double area = 0.0;
  Vec3 first = Vec3::Zero();    // integral of x
  Mat3 second = Mat3::Zero();   // integral of x x^T
  Vec3 normal = Vec3::Zero();   // integral of n
  Mat3 normal2 = Mat3::Zero();  // integral of n n^T

  Moments& operator+=(const Moments& other) {
    area += other.area;
    first += other.first;
    second += other.second;
    normal += other.normal;
    normal2 += other.normal2;
    return *this;
  }
};

Moments moments_of(const TriangleCorners& triangle) {
  Moments moments;
  const Vec3 cross = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double length = cross.norm();
  if (!(length > 0.0)) return moments;
  moments.area = 0.5 * length;
  const Vec3 sum = triangle[0] + triangle[1] + triangle[2];
  moments.first = moments.area / 3.0 * sum;
  // integral of x x^T over a triangle = area / 12 * (sum of v v^T + s s^T), s = sum of v
  Mat3 outer = sum * sum.transpose();
  for (const Vec3& corner : triangle) outer += corner * corner.transpose();
  moments.second = moments.area / 12.0 * outer;
  const Vec3 unit = cross / length;
  moments.normal = moments.area * unit;
  moments.normal2 = moments.area * unit * unit.transpose();
  return moments;
}

// Of a node without area (only degenerate triangles): its corners stand for its surface.
Mat3 covariance_of_corners(std::span<const TriangleCorners> triangles, Vec3& centroid) {
  centroid.setZero();
  for (const TriangleCorners& triangle : triangles) centroid += (triangle[0] + triangle[1] + triangle[2]) / 3.0;
  centroid /= static_cast<double>(triangles.size());
  Mat3 covariance = Mat3::Zero();
  for (const TriangleCorners& triangle : triangles) {
    for (const Vec3& corner : triangle) covariance += (corner - centroid) * (corner - centroid).transpose();
  }
  return covariance;
}

// Columns by increasing variance, right-handed.
volume::PrincipalAxes principal_axes(const Mat3& covariance) {
  const double scale = covariance.cwiseAbs().maxCoeff();
  if (!(scale > 0.0) || !std::isfinite(scale)) return Mat3::Identity();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance / scale);
  if (solver.info() != Eigen::Success || !solver.eigenvectors().allFinite()) return Mat3::Identity();
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  return axes;
}

float rounded_outwards(double half) { return std::nextafter(static_cast<float>(half), INFINITY); }

ODDS_KEEPS_ROUNDING void measure_slab(NodeStatistics& node, std::span<const TriangleCorners> triangles) {
  double lower = INFINITY;
  double upper = -INFINITY;
  const Vec3 normal = node.slab_normal.cast<double>();
  for (const TriangleCorners& triangle : triangles) {
    for (const Vec3& corner : triangle) {
      const double offset = normal.dot(corner);
      lower = std::min(lower, offset);
      upper = std::max(upper, offset);
    }
  }
  node.slab_center = static_cast<float>(0.5 * (lower + upper));
  const double center = static_cast<double>(node.slab_center);
  node.slab_half = rounded_outwards(std::max(upper - center, center - lower));
}

void fill_statistics(NodeStatistics& node, volume::PrincipalAxes& axes, const Moments& moments,
                     std::span<const TriangleCorners> triangles) {
  Vec3 centroid;
  Mat3 covariance;
  if (moments.area > 0.0) {
    centroid = moments.first / moments.area;
    covariance = moments.second / moments.area - centroid * centroid.transpose();
    node.mean_normal = (moments.normal / moments.area).cast<float>();
    const Mat3 m = moments.normal2 / moments.normal2.trace();
    const double packed[6] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
    std::transform(packed, packed + 6, node.normal_moment, [](double x) { return static_cast<float>(x); });
  } else {
    covariance = covariance_of_corners(triangles, centroid);
  }
  node.area = static_cast<float>(moments.area);
  node.centroid = centroid.cast<float>();
  axes = principal_axes(covariance);
  // Shortened, so that after rounding it is not longer than 1 and the slab's gaps are distances.
  node.slab_normal = (axes.col(0) * (1.0 - 0x1p-22)).cast<float>();
  measure_slab(node, triangles);
}

}  // namespace

void relate_area(NodeStatistics& node, double volume) noexcept {
  const double relative = static_cast<double>(node.area) / std::pow(volume, 2.0 / 3.0);
  node.relative_area = static_cast<float>(relative);
  node.log_relative_area = math::rough_log2(relative);
  node.log_volume = math::rough_log2(volume);
}

std::vector<TriangleCorners> corners_about(const mesh::TriangleMesh& mesh, const Vec3& origin) {
  std::vector<TriangleCorners> corners(mesh.triangles().size());
  for_parts(corners.size(), parallel_part, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) corners[i][k] = mesh.vertices()[mesh.triangles()[i][k]] - origin;
    }
  });
  return corners;
}

NodeSurface measure_surface(const Topology& topology, std::span<const TriangleCorners> corners,
                            std::span<const std::uint8_t> wanted) {
  NodeSurface surface;
  surface.statistics.resize(topology.nodes.size());
  surface.axes.resize(topology.nodes.size());
  std::vector<Moments> moments(topology.nodes.size());
  for_parts(topology.nodes.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const TopologyNode& node = topology.nodes[i];
      if (!node.is_leaf()) continue;
      for (std::uint32_t t = node.begin; t < node.end; ++t) moments[i] += moments_of(corners[t]);
    }
  });
  for (std::size_t i = topology.nodes.size(); i-- > 0;) {  // children come after their parents
    const TopologyNode& node = topology.nodes[i];
    if (node.is_leaf()) continue;
    moments[i] = moments[node.first];
    moments[i] += moments[node.first + 1];
  }
  for_parts(topology.nodes.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!wanted.empty() && wanted[i] == 0) continue;
      const TopologyNode& node = topology.nodes[i];
      surface.statistics[i].depth = node.depth;
      surface.statistics[i].height = node.height;
      fill_statistics(surface.statistics[i], surface.axes[i], moments[i],
                      corners.subspan(node.begin, node.end - node.begin));
    }
  });
  return surface;
}

}  // namespace odds::tree
