// One geom of every class that a mesh can meet, with what it needs to be known.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ode/trimesh_fixture.hpp"

namespace odds::test {

/// A tetrahedron as the arrays of dCreateConvex, which keeps pointers to them.
struct Tetrahedron {
  static constexpr double s = 0.57735026918962576;
  std::array<dReal, 12> points = {-0.3, -0.3, -0.3, 0.9, -0.3, -0.3, -0.3, 0.9, -0.3, -0.3, -0.3, 0.9};
  std::array<dReal, 16> planes = {0, 0, -1, 0.3, 0, -1, 0, 0.3, -1, 0, 0, 0.3, s, s, s, 0.3 * s};
  std::array<unsigned, 16> polygons = {3, 0, 2, 1, 3, 0, 1, 3, 3, 0, 3, 2, 3, 1, 2, 3};
};

/// The geoms stand in `space` and are forgotten and destroyed with this. Not the plane: it has no pose.
class Partners {
 public:
  explicit Partners(dSpaceID space) : trimesh_(box_shape(0.5, 0.5, 0.5, 1)->mesh(), space) {
    static constexpr std::array<float, 4> heights = {0.0f, 0.1f, 0.2f, 0.1f};
    field_ = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildSingle(field_, heights.data(), 1, 1, 1, 2, 2, 1, 0, 1, 0);
    oddsHeightfield description = {};
    description.height = [](void*, int x, int z) -> dReal { return heights[static_cast<std::size_t>(x + 2 * z)]; };
    description.width = description.depth = description.scale = description.thickness = 1;
    description.width_samples = description.depth_samples = 2;
    const oddsMeshDataID data = oddsMeshDataCreate();
    if (oddsMeshDataBuildHeightfield(data, &description, nullptr) == 0) throw std::runtime_error(oddsGetLastError());
    const dGeomID heightfield = dCreateHeightfield(space, field_, 1);
    oddsSetStandIn(heightfield, data, 1);
    oddsMeshDataDestroy(data);
    const dGeomID convex = dCreateConvex(space, tetrahedron_.planes.data(), 4, tetrahedron_.points.data(), 4,
                                         tetrahedron_.polygons.data());
    oddsRegisterConvex(convex, tetrahedron_.points.data(), 4, tetrahedron_.polygons.data(), 4);
    const dGeomID ray = dCreateRay(space, 2);
    owned_ = {dCreateSphere(space, 0.3),
              dCreateBox(space, 0.4, 0.4, 0.4),
              dCreateCapsule(space, 0.2, 0.3),
              dCreateCylinder(space, 0.2, 0.4),
              ray,
              convex,
              heightfield};
    all = owned_;
    all.push_back(trimesh_.geom);
  }
  ~Partners() {
    for (const dGeomID geom : owned_) {
      oddsForgetGeom(geom);
      dGeomDestroy(geom);
    }
    dGeomHeightfieldDataDestroy(field_);
  }
  Partners(const Partners&) = delete;
  Partners& operator=(const Partners&) = delete;

  std::vector<dGeomID> all;

 private:
  Tetrahedron tetrahedron_;
  TriMesh trimesh_;
  dHeightfieldDataID field_ = nullptr;
  std::vector<dGeomID> owned_;
};

}  // namespace odds::test
