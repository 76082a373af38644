// Every made shape: counts, closedness, orientation, volume against closed forms, refusals, repeatability.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>
#include <set>

#include "odds/mesh/made/bolt.hpp"
#include "odds/mesh/made/box.hpp"
#include "odds/mesh/made/bumpy_sphere.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/made/car_body.hpp"
#include "odds/mesh/made/gear.hpp"
#include "odds/mesh/made/icosphere.hpp"
#include "odds/mesh/made/nut.hpp"
#include "odds/mesh/made/peg.hpp"
#include "odds/mesh/made/plate_with_hole.hpp"
#include "odds/mesh/made/torus_knot.hpp"
#include "support/mesh_checks.hpp"

namespace odds::mesh::made {
namespace {

using testing::edge_census;
using testing::signed_volume;
constexpr double pi = std::numbers::pi;

TriangleMesh made(std::string_view text) {
  Result<TriangleMesh> mesh = make_shape(text);
  if (!mesh.ok()) throw std::runtime_error(mesh.error().message());
  return std::move(mesh).value();
}

struct Expected {
  std::string_view text;
  std::size_t triangles;
  double volume;     ///< cubic metres
  double tolerance;  ///< relative; what the facets take away
  int genus = 0;
};

class ClosedShapes : public ::testing::TestWithParam<Expected> {};

TEST_P(ClosedShapes, AreClosedOutwardAndOfTheRightVolume) {
  const Expected& expected = GetParam();
  const TriangleMesh mesh = made(expected.text);
  EXPECT_EQ(mesh.triangles().size(), expected.triangles);
  const auto census = edge_census(mesh);
  EXPECT_EQ(census.boundary, 0u);
  EXPECT_EQ(census.non_manifold, 0u);
  EXPECT_EQ(census.inconsistent, 0u);
  const auto euler = static_cast<long>(mesh.vertices().size()) - static_cast<long>(census.edges) +
                     static_cast<long>(mesh.triangles().size());
  EXPECT_EQ(euler, 2 - 2 * expected.genus);
  EXPECT_NEAR(signed_volume(mesh) / expected.volume, 1.0, expected.tolerance);
}

INSTANTIATE_TEST_SUITE_P(
    AllThatHaveAClosedForm, ClosedShapes,
    ::testing::Values(
        Expected{"box:x=1,y=2,z=3,cells=4", 192, 6.0, 1e-12},  //
        Expected{"icosphere:radius=2,frequency=32", 20480, 4.0 / 3.0 * pi * 8.0, 2e-3},
        Expected{"uv_sphere:radius=2,around=128,down=64", 2 * 128 * 63, 4.0 / 3.0 * pi * 8.0, 2e-3},
        Expected{"bumpy_sphere:height=0,radius=1,frequency=32", 20480, 4.0 / 3.0 * pi, 2e-3},
        Expected{"torus:ring=2,tube=0.5,around=200,across=100", 40000, 2 * pi* pi * 2 * 0.25, 2e-3, 1},
        // Pappus: section area times the length of the centre line (p = q = 1 winding thin: near 2 pi ring).
        Expected{"torus_knot:p=1,q=1,ring=1,winding=0.001,tube=0.1,along=400,across=100", 80000, pi * 0.01 * 2 * pi,
                 2e-3, 1},
        Expected{"peg:radius=1,length=5,chamfer=0.1,around=256,along=4", 2 * 256 * 6,
                 pi*(5 - 0.1) + pi * 0.1 / 3 * (1 + 0.9 + 0.81), 2e-4},
        Expected{"plate_with_hole:side=4,thickness=0.5,peg_radius=1,clearance=0.1,around=512,across=3,along=2",
                 2 * 512 * (2 * 3 + 2 * 2), 0.5 * (16 - pi * 1.21), 2e-4, 1},
        Expected{"terrain:height=0,depth=0.5,side=2,cells=10", 200 + 80 + 40, 2.0, 1e-12},
        Expected{"plates:count=1,side=2,thickness=0.1,cells=5", 4 * 25 + 40, 0.4, 1e-12}),
    [](const auto& tested) {
      const std::string_view text = tested.param.text;
      return std::string(text.substr(0, text.find(':')));
    });

TEST(MadeShapes, EveryDefaultIsFreeOfZeroAreasAndHasItsNameAsRecipe) {
  for (const std::string_view name : shape_names()) {
    const TriangleMesh mesh = made(name);
    EXPECT_EQ(mesh.name(), "made:" + std::string(name));
    const double size = mesh.size();
    for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
      ASSERT_GT(testing::triangle_area(mesh, i), 1e-12 * size * size) << name << " triangle " << i;
    }
    const auto census = edge_census(mesh);
    EXPECT_EQ(census.non_manifold, 0u) << name;
    EXPECT_EQ(census.inconsistent, 0u) << name;
    const bool open = name == "terrain" || name == "car_body";
    EXPECT_EQ(census.boundary > 0, open) << name;
    if (!open) {
      EXPECT_GT(signed_volume(mesh), 0.0) << name;
    }
  }
}

TEST(MadeShapes, SameTextGivesTheSameBitsAndAnotherSeedDoesNot) {
  for (const std::string_view name : {"bumpy_sphere", "terrain", "car_body", "nested_shells"}) {
    const TriangleMesh first = made(name);
    const TriangleMesh again = made(name);
    const TriangleMesh other = made(std::string(name) + ":seed=2");
    EXPECT_TRUE(std::equal(first.vertices().begin(), first.vertices().end(), again.vertices().begin())) << name;
    EXPECT_FALSE(std::equal(first.vertices().begin(), first.vertices().end(), other.vertices().begin())) << name;
  }
}

TEST(MadeShapes, ANameIsARecipeForTheSameMesh) {
  const CarBody car{.length = 4.1, .triangles = 1234, .seed = 18446744073709551615ULL};
  const TriangleMesh direct = make(car).value();
  EXPECT_EQ(direct.name(), "made:car_body:length=4.1,triangles=1234,seed=18446744073709551615");
  const TriangleMesh by_name = made(direct.name());
  ASSERT_EQ(direct.vertices().size(), by_name.vertices().size());
  EXPECT_TRUE(std::equal(direct.vertices().begin(), direct.vertices().end(), by_name.vertices().begin()));
}

TEST(MadeShapes, TheListByNameHoldsEveryHeader) {
  const std::filesystem::path folder = std::filesystem::path(ODDS_SOURCE_DIR) / "include/odds/mesh/made";
  std::set<std::string> in_headers;
  const std::regex name("string_view name = \"([a-z_]+)\"");
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    std::ifstream stream(file.path());
    const std::string text((std::istreambuf_iterator<char>(stream)), {});
    std::smatch match;
    if (!std::regex_search(text, match, name)) continue;
    in_headers.insert(match[1]);
    EXPECT_EQ(match[1].str() + ".hpp", file.path().filename().string());
  }
  const auto names = shape_names();
  EXPECT_EQ(in_headers, std::set<std::string>(names.begin(), names.end()));
  for (const std::string_view each : names) EXPECT_FALSE(describe_shape(each).empty());
}

TEST(MadeShapes, ErrorsSuggestTheNearestName) {
  EXPECT_NE(make_shape("made:toruss").error().message().find("did you mean \"torus\"?"), std::string::npos);
  EXPECT_NE(make_shape("icosphere:radius=1,radius=2").error().message().find("\"radius\" is given twice"),
            std::string::npos);
  EXPECT_NE(make_shape("torus:rin=1").error().message().find("did you mean \"ring\"?"), std::string::npos);
  EXPECT_EQ(make_shape("torus:ring=-1").error().message(),
            "made:torus: ring = -1 is out of range; give a value from 1e-06 to 10000");
}

TEST(MadeShapes, MalformedSettingsAreRefused) {
  for (const std::string_view bad : {"",
                                     "made:",
                                     ":",
                                     "box:x",
                                     "box:x=",
                                     "box:=1",
                                     "box:x=1e",
                                     "box:x=nan",
                                     "box:x=inf",
                                     "box:cells=1.5",
                                     "box:cells=-1",
                                     "box:x=1;y=2",
                                     "box:,",
                                     "box:x= 1",
                                     "car_body:seed=18446744073709551616",
                                     "torus:tube=1,ring=0.5",
                                     "torus_knot:p=2,q=4",
                                     "torus_knot:tube=0.05",
                                     "gear:bore=1",
                                     "gear:teeth=20,backlash=0.01",
                                     "bolt:pitch=0.004",
                                     "bolt:around=50",
                                     "bolt:length=0.001",
                                     "bolt:across_flats=0.009",
                                     "nut:clearance=0.001",
                                     "peg:chamfer=1",
                                     "plate_with_hole:around=12",
                                     "plate_with_hole:clearance=0.1",
                                     "plates:count=1000,cells=1000",
                                     "plates:thickness=1e-300",
                                     "car_body:triangles=10"}) {
    const auto mesh = make_shape(bad);
    ASSERT_FALSE(mesh.ok()) << bad;
    EXPECT_FALSE(mesh.error().remedy.empty()) << bad;
  }
}

TEST(CarBody, HasExactlyTheTrianglesAskedFor) {
  for (const std::uint32_t count : {500u, 501u, 2000u, 9999u, 60000u, 60001u, 60755u, 250000u}) {
    const TriangleMesh mesh = make(CarBody{.triangles = count}).value();
    EXPECT_EQ(mesh.triangles().size(), count);
    const auto census = edge_census(mesh);
    EXPECT_EQ(census.non_manifold + census.inconsistent, 0u) << count;
  }
}

TEST(CarBody, HasTheSizeOfACar) {
  const TriangleMesh mesh = make(CarBody{}).value();
  const Vec3 size = mesh.upper() - mesh.lower();
  EXPECT_NEAR(size.x(), 4.6, 0.15);
  EXPECT_NEAR(size.y(), 1.77, 0.1);
  EXPECT_NEAR(mesh.upper().z(), 1.38, 0.03);
  EXPECT_GT(mesh.lower().z(), 0.15);
}

TEST(SpurGear, LiesBetweenRootAndTipAndHasThePitchThickness) {
  const SpurGear gear;
  const TriangleMesh mesh = make(gear).value();
  const double pitch_radius = 0.5 * gear.module * gear.teeth;
  double outermost = 0.0;
  for (const Vec3& v : mesh.vertices()) outermost = std::max(outermost, std::hypot(v.x(), v.y()));
  EXPECT_NEAR(outermost, pitch_radius + gear.module, 1e-12);
  // Teeth and spaces are equal at the pitch circle, so the volume is near that of the pitch cylinder less the bore.
  const double cylinder = pi * (pitch_radius * pitch_radius - gear.bore * gear.bore) * gear.width;
  EXPECT_NEAR(signed_volume(mesh) / cylinder, 1.0, 0.05);
}

/// Radius of the surface where a ray from the axis at height z and angle meets it, or 0.
double radius_along_ray(const TriangleMesh& mesh, double angle, double z) {
  const Vec3 direction(std::cos(angle), std::sin(angle), 0.0);
  const Vec3 origin(0.0, 0.0, z);
  double nearest = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const Vec3& a = mesh.vertices()[t[0]];
    Mat3 system;
    system << direction, a - mesh.vertices()[t[1]], a - mesh.vertices()[t[2]];
    if (std::abs(system.determinant()) < 1e-30) continue;
    const Vec3 solution = system.inverse() * (a - origin);  // a + u (b-a) + v (c-a) = origin + r direction
    const bool inside = solution[1] >= -1e-9 && solution[2] >= -1e-9 && solution[1] + solution[2] <= 1.0 + 1e-9;
    if (inside && solution[0] > 0.0 && (nearest == 0.0 || solution[0] < nearest)) nearest = solution[0];
  }
  return nearest;
}

TEST(BoltAndNut, TheThreadIsRightHandedOfThePitchAndBetweenItsDiameters) {
  const Bolt bolt;
  const TriangleMesh mesh = make(bolt).value();
  const double major = 0.5 * bolt.diameter;
  const double minor = major - 0.541265877 * bolt.pitch;
  const double middle_of_crest = bolt.pitch * 10.5;
  EXPECT_NEAR(radius_along_ray(mesh, 0.0, middle_of_crest), major, 1e-9);
  EXPECT_NEAR(radius_along_ray(mesh, 0.0, middle_of_crest + 0.5 * bolt.pitch), minor, 1e-9);
  const double quarter_turn_higher = middle_of_crest + 0.25 * bolt.pitch;
  EXPECT_NEAR(radius_along_ray(mesh, 0.5 * pi, quarter_turn_higher), major, 1e-9);
  EXPECT_NEAR(radius_along_ray(mesh, 0.0, middle_of_crest - bolt.pitch / 4.0), major - 0.6 * 0.541265877 * bolt.pitch,
              1e-9);
}

TEST(BoltAndNut, TheClearanceIsRealAllAround) {
  for (const double clearance : {-4e-5, 3e-5, 1e-4}) {
    const Bolt bolt;
    const Nut nut{.clearance = clearance};
    const TriangleMesh bolt_mesh = make(bolt).value();
    const TriangleMesh nut_mesh = make(nut).value();
    EXPECT_GT(signed_volume(nut_mesh), 0.0);
    double least = 1.0;
    double greatest = -1.0;
    const double raised = 7.0 * bolt.pitch + 0.3 * bolt.pitch;  // raised and turned by the same share of a turn
    for (int i = 0; i < 97; ++i) {
      const double angle = 2.0 * pi * i / 97.0;
      const double z = nut.height * (0.3 + 0.4 * (i % 13) / 13.0);
      const double outer = radius_along_ray(nut_mesh, angle, z);
      const double inner = radius_along_ray(bolt_mesh, angle + 2.0 * pi * 0.3, z + raised);
      least = std::min(least, outer - inner);
      greatest = std::max(greatest, outer - inner);
    }
    // On flanks the radial gap is twice the gap along the normal.
    const double facets = 0.5 * bolt.diameter * (1.0 / std::cos(pi / nut.around) - std::cos(pi / nut.around));
    EXPECT_GE(least, std::min(clearance, 2.0 * clearance) - 1e-6);
    EXPECT_LE(greatest, std::max(clearance, 2.0 * clearance) + 2.0 * facets);
  }
}

TEST(PegAndPlate, TheGapIsTheClearance) {
  const Peg peg;
  const PlateWithHole plate{.clearance = 2e-5};
  const TriangleMesh peg_mesh = make(peg).value();
  const TriangleMesh plate_mesh = make(plate).value();
  double narrowest = 1.0;
  for (int i = 0; i < 128; ++i) {
    narrowest = std::min(narrowest, radius_along_ray(plate_mesh, 2.0 * pi * i / 128.0, -0.5 * plate.thickness));
  }
  EXPECT_NEAR(narrowest, peg.radius + plate.clearance, 1e-12);
  EXPECT_NEAR(radius_along_ray(peg_mesh, 0.0, 0.5 * peg.length), peg.radius, 1e-12);
}

TEST(BumpySphere, StaysWithinItsHeightAndScales) {
  const BumpySphere outer{.height = 0.2};
  const BumpySphere inner{.height = 0.2, .scale = 0.985};
  const TriangleMesh a = make(outer).value();
  const TriangleMesh b = make(inner).value();
  double lowest = 1.0;
  double highest = 0.0;
  for (std::size_t i = 0; i < a.vertices().size(); ++i) {
    const double share = a.vertices()[i].norm() / outer.radius;
    lowest = std::min(lowest, share);
    highest = std::max(highest, share);
    ASSERT_NEAR(b.vertices()[i].norm(), 0.985 * a.vertices()[i].norm(), 1e-15);
  }
  EXPECT_GE(lowest, 0.8);
  EXPECT_LE(highest, 1.2);
  EXPECT_LT(lowest, 0.9);   // there are hollows
  EXPECT_GT(highest, 1.1);  // and bumps
}

TEST(NestedShells, AreAWallBetweenTwoSurfaces) {
  const double hollow = signed_volume(made("nested_shells:ratio=0.5"));
  const double full = signed_volume(made("bumpy_sphere"));
  EXPECT_NEAR(hollow, full * (1.0 - 0.125), 1e-12);
}

/// Also by a compiler that evaluates arguments from the left.
TEST(MadeShapes, BoxesAreNumberedInOneWay) {
  const TriangleMesh box = made("box:x=2,y=2,z=2,cells=1");
  const std::vector<Vec3> expected = {{-1, 1, -1}, {-1, 1, 1}, {-1, -1, 1}, {-1, -1, -1},
                                      {1, -1, 1},  {1, 1, 1},  {1, 1, -1},  {1, -1, -1}};
  ASSERT_EQ(box.vertices().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(box.vertices()[i], expected[i]) << i;
}

}  // namespace
}  // namespace odds::mesh::made
