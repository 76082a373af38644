// What imported bodies are made of encloses what its parts enclose.
#include "haptics/import_fixture.hpp"
#include "odds/mesh/enclosed_volume.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/write.hpp"

namespace odds::scene {
namespace {

// A part whose triangles face inwards was joined to the others as it was: a hole of its volume. Two like it enclosed
// nothing together, and one alone was a sheet.
TEST_F(Import, MeshesThatAreInsideOutAreTurned) {
  const mesh::TriangleMesh box = mesh::made::make_shape("made:box:x=1,y=2,z=3").value();
  std::vector<mesh::Triangle> inwards;
  for (const mesh::Triangle& t : box.triangles()) inwards.push_back({t[0], t[2], t[1]});
  const mesh::TriangleMesh turned =
      mesh::TriangleMesh::make({box.vertices().begin(), box.vertices().end()}, inwards, "turned").value();
  ASSERT_FALSE(mesh::write(box, folder_ / "box.obj"));
  ASSERT_FALSE(mesh::write(turned, folder_ / "turned.obj"));
  const auto part = [](const std::string& file, const std::string& x, const std::string& scale) {
    return "<collision><origin xyz=\"" + x + " 0 0\"/><geometry><mesh filename=\"" + file + "\" scale=\"" + scale +
           "\"/></geometry></collision>";
  };
  const std::string good_part = part("box.obj", "0", "1 1 1");
  for (const std::string& bad : {part("turned.obj", "5", "1 1 1"), part("turned.obj", "5", "1 -1 1"),
                                 part("turned.obj", "5", "1 1 1") + part("turned.obj", "9", "-1 1 1")}) {
    for (const std::string& parts : {good_part + bad, bad}) {
      const ImportedScene imported = good("r.urdf", urdf(link("a", parts)));
      ASSERT_EQ(imported.meshes.size(), 1U);
      const mesh::TriangleMesh& mesh = imported.meshes[0].mesh;
      const auto count = static_cast<double>(mesh.triangles().size()) / static_cast<double>(box.triangles().size());
      EXPECT_NEAR(mesh::enclosed_volume(mesh).value_or(0.0), 6.0 * count, 1e-9) << parts;
      EXPECT_TRUE(assumes(imported, "1 mesh files have triangles that face the wrong way"));
    }
  }
  EXPECT_FALSE(assumes(good("r.urdf", urdf(link("a", good_part))), "face the wrong way"));
}

}  // namespace
}  // namespace odds::scene
