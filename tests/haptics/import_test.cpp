// Descriptions of robots and worlds become scenes: frames, units, groups, masses; and what is refused, where.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

#include "haptics/import_fixture.hpp"
#include "odds/mesh/faults.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/write.hpp"
#include "odds/scene/simulation.hpp"

namespace odds::scene {
namespace {

// Turned by 90 degrees about z, then about y: URDF's rpy is about fixed axes x, y, z in this order.
TEST_F(Import, UrdfOriginsAreXyzAndRollPitchYawAboutFixedAxes) {
  const std::string half_pi = std::to_string(std::numbers::pi / 2.0);
  const ImportedScene imported =
      good("r.urdf",
           urdf(link("a", box_of("0.1 0.2 0.4", "<origin xyz=\"1 2 3\" rpy=\"0 " + half_pi + " " + half_pi + "\"/>"))));
  ASSERT_EQ(imported.meshes.size(), 1U);
  // x, y, z of the box go to -z, -x, y of the link.
  expect_box(imported.meshes[0].mesh, {0.9, 1.8, 2.95}, {1.1, 2.2, 3.05}, 1e-6);
}

TEST_F(Import, LinksOnFixedJointsAreOneBodyAndOthersAreHeldAtZero) {
  const std::string text =
      urdf(link("world", "") + link("base", box_of("1 1 1")) + link("cover", box_of("0.2 0.2 0.2")) +
           link("arm", box_of("0.1 0.1 0.1")) +
           R"(<joint name="bolted" type="fixed"><parent link="world"/><child link="base"/><origin xyz="0 0 10"/></joint>
         <joint name="glued" type="fixed"><parent link="base"/><child link="cover"/><origin xyz="0 0 1"/></joint>
         <joint name="elbow" type="revolute"><parent link="cover"/><child link="arm"/>
           <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/></joint>)");
  const ImportedScene imported = good("r.urdf", text);
  EXPECT_EQ(imported.links, 4U);
  EXPECT_EQ(imported.joints, 3U);
  EXPECT_TRUE(assumes(imported, "1 joints that move ('elbow', revolute and the like) are held at zero"));
  const Scene scene = scene_of(imported);
  ASSERT_EQ(scene.bodies.size(), 2U);
  EXPECT_FALSE(scene.bodies[0].dynamic);
  EXPECT_LT((scene.bodies[0].pose.translation - Vec3(0, 0, 10)).norm(), 1e-12);
  expect_box(imported.meshes[0].mesh, {-0.5, -0.5, -0.5}, {0.5, 0.5, 1.1}, 1e-12);
  EXPECT_LT((scene.bodies[1].pose.translation - Vec3(0, 0, 12)).norm(), 1e-12);
  EXPECT_LT((scene.bodies[1].pose.rotation * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
}

// A floating joint holds nothing: it says where its child begins.
TEST_F(Import, WhatHangsOnAFloatingJointMovesOnItsOwn) {
  const std::string inertial = "<inertial><mass value=\"2.5\"/></inertial>";
  const ImportedScene imported = good(
      "r.urdf",
      urdf(link("world", "") + link("base", inertial + box_of("1 1 1")) + link("lid", inertial + box_of("1 1 1")) +
           R"(<joint name="f" type="floating"><parent link="world"/><child link="base"/><origin xyz="0 0 3"/></joint>
         <joint name="g" type="floating"><parent link="base"/><child link="lid"/><origin xyz="0 0 2"/></joint>)"));
  EXPECT_FALSE(assumes(imported, "held at zero"));
  const Scene scene = scene_of(imported);
  ASSERT_EQ(scene.bodies.size(), 2U);
  for (const Body& body : scene.bodies) {
    EXPECT_TRUE(body.dynamic) << body.name;
    EXPECT_EQ(body.mass.mass_kg, 2.5) << body.name;
  }
  EXPECT_LT((scene.bodies[1].pose.translation - Vec3(0, 0, 5)).norm(), 1e-12);
}

TEST_F(Import, ARobotThatStandsOnNothingMovesAsOneWithItsMass) {
  const std::string inertial = "<inertial><mass value=\"2.5\"/></inertial>";
  const ImportedScene imported =
      good("r.urdf",
           urdf(link("a", inertial + box_of("1 1 1") + "<visual/>") + link("b", inertial + box_of("1 1 1")) +
                R"(<joint name="j" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0 0 1"/></joint>
              <gazebo reference="a"><mu1>0.3</mu1></gazebo><gazebo reference="b"><mu1 value="0.8"/></gazebo>)"));
  EXPECT_TRUE(assumes(imported, "left out: 1 <visual>"));
  EXPECT_TRUE(assumes(imported, "friction differs, from 0.3 to 0.8"));
  Scene scene = scene_of(imported);
  ASSERT_EQ(scene.bodies.size(), 1U);
  EXPECT_TRUE(scene.bodies[0].dynamic);
  EXPECT_EQ(scene.bodies[0].mass.mass_kg, 5.0);
  ASSERT_NE(scene.find_effect("friction"), nullptr);
  SimulationOptions options;
  options.simulated_time = true;
  options.seconds = 0.1;
  auto simulation = Simulation::make(std::move(scene), options);
  ASSERT_TRUE(simulation.ok()) << simulation.error().message();
  const RunOutcome outcome = simulation.value()->run();
  EXPECT_EQ(outcome.ticks.size(), 100U);
  EXPECT_NEAR(simulation.value()->world().state({0}).velocity_m_per_s.z(), -0.981, 1e-3);
}

TEST_F(Import, MeshesAreScaledAndFoundInPackages) {
  const auto block = mesh::made::make_shape("made:box:x=1,y=2,z=3");
  ASSERT_TRUE(block.ok());
  std::filesystem::create_directories(folder_.path() / "pack/meshes");
  std::filesystem::create_directories(folder_.path() / "pack/urdf");
  ASSERT_FALSE(mesh::write(block.value(), folder_.path() / "pack/meshes/block.stl"));
  const auto text = [](const std::string& uri, const std::string& scale) {
    return urdf(link("a", "<collision><geometry><mesh filename=\"" + uri + "\"" + scale + "/></geometry></collision>"));
  };
  // From inside of the package, by its folder's name; from elsewhere, by --package; by a plain path.
  const std::string mirrored = " scale=\"0.001 0.001 -0.001\"";
  const ImportedScene inside = good("pack/urdf/r.urdf", text("package://pack/meshes/block.stl", mirrored));
  ASSERT_EQ(inside.meshes.size(), 1U);
  expect_box(inside.meshes[0].mesh, {-0.0005, -0.001, -0.0015}, {0.0005, 0.001, 0.0015}, 1e-9);
  EXPECT_TRUE(mesh::find_faults(inside.meshes[0].mesh).closed);
  ImportOptions options;
  options.packages["elsewhere"] = folder_.path() / "pack";
  EXPECT_EQ(good("r.urdf", text("package://elsewhere/meshes/block.stl", ""), options).bodies, 1U);
  EXPECT_EQ(good("r.urdf", text("pack/meshes/block.stl", "")).bodies, 1U);
  EXPECT_EQ(good("r.urdf", text("file://" + folder_ / "pack/meshes/block.stl", "")).bodies, 1U);
  EXPECT_EQ(good("r.urdf", text("file://pack/meshes/block.stl", "")).bodies, 1U) << "wherever import is called";
}

TEST_F(Import, MeshesAreFoundInRos2sPackages) {
  std::filesystem::create_directories(folder_.path() / "install/share/arm/meshes");
  ASSERT_FALSE(
      mesh::write(mesh::made::make_shape("made:box").value(), folder_.path() / "install/share/arm/meshes/a.stl"));
  const std::string text =
      urdf(link("a", "<collision><geometry><mesh filename=\"package://arm/meshes/a.stl\"/></geometry></collision>"));
  const char* const before = std::getenv("AMENT_PREFIX_PATH");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("AMENT_PREFIX_PATH", ("/nowhere:" + folder_ / "install").c_str(), 1);
  EXPECT_EQ(good("r.urdf", text).bodies, 1U);
  before == nullptr ? ::unsetenv("AMENT_PREFIX_PATH") : ::setenv("AMENT_PREFIX_PATH", kept.c_str(), 1);
}

TEST_F(Import, AddressesHaveBlanksAsTheyAreOrAsProgramsWriteThem) {
  std::filesystem::create_directories(folder_.path() / "my parts");
  const mesh::TriangleMesh box = mesh::made::make_shape("made:box").value();
  ASSERT_FALSE(mesh::write(box, folder_.path() / "my parts/a b.stl"));
  ASSERT_FALSE(mesh::write(box, folder_.path() / "my parts/50%20.stl"));
  const auto text = [](const std::string& uri) {
    return urdf(link("a", "<collision><geometry><mesh filename=\"" + uri + "\"/></geometry></collision>"));
  };
  for (const char* const uri :
       {"file://my%20parts/a%20b.stl", "file://my parts/a b.stl", "my parts/a b.stl", "package://my%20parts/a%20b.stl",
        "file://my%20parts/50%2520.stl", "my parts/50%20.stl", "file://my parts/50%20.stl"}) {
    EXPECT_EQ(good("r.urdf", text(uri)).bodies, 1U) << uri;
  }
}

TEST_F(Import, AddressesGoUpBehindLinksAsTheSystemDoes) {
  std::filesystem::create_directories(folder_.path() / "store/meshes");
  std::filesystem::create_directory_symlink(folder_.path() / "store/meshes", folder_.path() / "link");
  ASSERT_FALSE(mesh::write(mesh::made::make_shape("made:box:x=1,y=1,z=1").value(), folder_.path() / "store/a.stl"));
  ASSERT_FALSE(mesh::write(mesh::made::make_shape("made:box:x=9,y=9,z=9").value(), folder_.path() / "b.stl"));
  ASSERT_FALSE(mesh::write(mesh::made::make_shape("made:box:x=2,y=2,z=2").value(), folder_.path() / "store/b.stl"));
  for (const auto& [uri, half] : {std::pair{"link/../a.stl", 0.5}, std::pair{"link/../b.stl", 1.0}}) {
    const ImportedScene imported = good(
        "r.urdf",
        urdf(link("a", "<collision><geometry><mesh filename=\"" + std::string(uri) + "\"/></geometry></collision>")));
    expect_box(imported.meshes.at(0).mesh, Vec3::Constant(-half), Vec3::Constant(half), 1e-6);
  }
}

TEST_F(Import, RoundShapesAreClosedAndOfTheirSize) {
  const auto shape = [](const std::string& element) {
    return urdf(link("a", "<collision><geometry>" + element + "</geometry></collision>"));
  };
  const ImportedScene cylinder = good("c.urdf", shape("<cylinder radius=\"0.1\" length=\"0.6\"/>"));
  expect_box(cylinder.meshes.at(0).mesh, {-0.1, -0.1, -0.3}, {0.1, 0.1, 0.3}, 1e-12);
  const ImportedScene sphere = good("s.urdf", shape("<sphere radius=\"0.1\"/>"));
  expect_box(sphere.meshes.at(0).mesh, {-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}, 1e-12);
  const ImportedScene capsule = good("k.urdf", shape("<capsule radius=\"0.1\" length=\"0.6\"/>"));
  expect_box(capsule.meshes.at(0).mesh, {-0.1, -0.1, -0.4}, {0.1, 0.1, 0.4}, 1e-12);
  for (const ImportedScene* each : {&cylinder, &sphere, &capsule}) {
    const mesh::TriangleMesh& mesh = each->meshes.at(0).mesh;
    EXPECT_TRUE(mesh::find_faults(mesh).closed);
    double volume = 0.0;
    for (const mesh::Triangle& t : mesh.triangles()) {
      volume += mesh.vertices()[t[0]].dot(mesh.vertices()[t[1]].cross(mesh.vertices()[t[2]])) / 6.0;
    }
    const double ball = 4.0 / 3.0 * std::numbers::pi * 0.001;
    const double tube = std::numbers::pi * 0.01 * 0.6;
    const double exact = each == &cylinder ? tube : each == &sphere ? ball : ball + tube;
    EXPECT_NEAR(volume / exact, 0.99, 0.01);  // outward, and inscribed
  }
}

TEST_F(Import, SdfPosesAreRelativeToWhatTheyName) {
  const std::string box = "<collision name=\"c\"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>";
  const ImportedScene imported = good("w.sdf", sdf(R"(<world name="w"><gravity>0 0 -1.62</gravity>
    <model name="m"><pose>10 0 0 0 0 90</pose><static>true</static>
      <frame name="mark" attached_to="b"><pose>0 0 1 0 0 0</pose></frame>
      <link name="a">)" + box + R"(<pose relative_to="mark">0 0 0.5 0 0 0</pose></link>
      <link name="b">)" + box + R"(<pose>1 0 0 0 0 0</pose></link>
      <model name="inner"><pose relative_to="b" degrees="true">0 0 0 0 0 90</pose>
        <link name="c"><pose rotation_format="quat_xyzw">0 1 0 0 0 0 1</pose>)" +
                                                   box + R"(</link></model>
    </model>
    <model name="loose"><link name="l">)" + box + R"(<inertial><mass>3</mass></inertial></link></model>
    <light name="sun"/></world>)"));
  const Scene scene = scene_of(imported);
  ASSERT_EQ(scene.bodies.size(), 4U);
  const double c = std::cos(90.0);  // the model's yaw was given in radians
  const double s = std::sin(90.0);
  EXPECT_LT((scene.bodies[0].pose.translation - Vec3(10 + c, s, 1.5)).norm(), 1e-9);
  EXPECT_LT((scene.bodies[1].pose.translation - Vec3(10 + c, s, 0)).norm(), 1e-9);
  // b's frame, turned by 90 degrees; then 1 m along y of that.
  EXPECT_LT((scene.bodies[2].pose.translation - Vec3(10 + c - c, s - s, 0)).norm(), 1e-9)
      << scene.bodies[2].pose.translation.transpose();
  EXPECT_FALSE(scene.bodies[2].dynamic);
  EXPECT_TRUE(scene.bodies[3].dynamic);
  EXPECT_EQ(scene.bodies[3].mass.mass_kg, 3.0);
  EXPECT_TRUE(assumes(imported, "left out: 1 <light>"));
  EXPECT_NE(imported.text.find("g_m_per_s2 = [0, 0, -1.62]"), std::string::npos) << imported.text;
}

// As in what Gazebo prints of a model with others in it (gz sdf -p).
TEST_F(Import, SdfCollisionsStandInTheFrameThatTheyName) {
  const auto box_at = [](const std::string& frame) {
    return "<collision name=\"c\"><pose relative_to=\"" + frame +
           "\">0 0 1 0 0 0</pose><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>";
  };
  const auto moved = [&](const std::string& frame) {
    return good("w.sdf", sdf(R"(<model name="m"><pose>5 0 0 0 0 0</pose><frame name="mark" attached_to="other">
      <pose>0 3 0 0 1.5707963267948966 0</pose></frame><link name="a"><pose>1 0 0 0 0 1.5707963267948966</pose>)" +
                             box_at(frame) + R"(</link><link name="other"/></model>)"));
  };
  const Vec3 half = Vec3::Constant(0.1);
  for (const std::string own : {"", "a"}) {
    expect_box(moved(own).meshes.at(0).mesh, Vec3(0, 0, 1) - half, Vec3(0, 0, 1) + half, 1e-12);
  }
  // One metre along z from the model's own frame: (-1, 0, 1) from the link, which is turned by 90 degrees.
  expect_box(moved("__model__").meshes.at(0).mesh, Vec3(0, 1, 1) - half, Vec3(0, 1, 1) + half, 1e-12);
  // The mark's z is the model's x: the box is at (1, 3, 0) there, and (0, 3, 0) from the link.
  expect_box(moved("mark").meshes.at(0).mesh, Vec3(3, 0, 0) - half, Vec3(3, 0, 0) + half, 1e-12);
  const Error error =
      refused("w.sdf", sdf("<model name=\"m\">\n<link name=\"mark\">" + box_at("mork") + "</link></model>"));
  EXPECT_EQ(error.place.rfind("3:", 0), 0U) << error.message();
  EXPECT_NE(error.what.find("there is no frame named 'm::mork'"), std::string::npos) << error.message();
}

// A joint's ends may be frames, joints and models: the links that they are attached to are meant.
TEST_F(Import, SdfJointsEndAtWhatIsAttachedToLinks) {
  const auto boxed = [](const std::string& name) {
    return "<link name=\"" + name +
           "\"><collision name=\"c\"><geometry><box><size>1 1 1</size></box></geometry></collision></link>";
  };
  const auto joined = [](const std::string& name, const std::string& parent, const std::string& child) {
    return "<joint name=\"" + name + "\" type=\"fixed\"><parent>" + parent + "</parent><child>" + child +
           "</child></joint>";
  };
  const auto bodies = [&](const std::string& joints) {
    const ImportedScene imported =
        good("w.sdf", sdf("<model name=\"m\">" + boxed("a") + boxed("b") +
                          "<frame name=\"tip\" attached_to=\"b\"/><frame name=\"end\" attached_to=\"tip\"/>"
                          "<frame name=\"outside\" attached_to=\"world\"/><model name=\"sub\" canonical_link=\"l\">" +
                          boxed("k") + boxed("l") + joined("in", "k", "l") + "</model>" + joints + "</model>"));
    const Scene scene = scene_of(imported);
    return std::pair(scene.bodies.size(), scene.bodies[0].dynamic);
  };
  EXPECT_EQ(bodies(""), std::pair(std::size_t{3}, true));  // a, b, and the model within
  EXPECT_EQ(bodies(joined("j", "end", "sub")), std::pair(std::size_t{2}, true));
  EXPECT_EQ(bodies(joined("j", "a", "sub::in")), std::pair(std::size_t{2}, true));
  EXPECT_EQ(bodies(joined("j", "b", "__model__")), std::pair(std::size_t{2}, true));
  EXPECT_EQ(bodies(joined("j", "outside", "sub")), std::pair(std::size_t{3}, true));
  EXPECT_EQ(bodies(joined("j", "outside", "a") + joined("i", "a", "sub")), std::pair(std::size_t{2}, false));
  EXPECT_NE(refused("w.sdf", sdf("<model name=\"m\">" + boxed("a") +
                                 "<frame name=\"x\" attached_to=\"y\"/><frame name=\"y\" attached_to=\"x\"/>" +
                                 joined("j", "a", "x") + "</model>"))
                .what.find("there is no link named 'x'"),
            std::string::npos);
}

TEST_F(Import, APlaneIsASlabWithItsTopThere) {
  const ImportedScene imported = good("w.sdf", sdf(R"(<model name="ground"><static>1</static><link name="l">
    <collision name="c"><geometry><plane><normal>0 0 2</normal><size>5 5</size></plane></geometry></collision>
    </link></model>)"));
  expect_box(imported.meshes.at(0).mesh, {-10, -10, -1}, {10, 10, 0}, 1e-12);
  EXPECT_TRUE(assumes(imported, "1 planes are slabs of 20 m by 20 m"));
}

// Gazebo reads booleans and names whatever the size of their letters and the blanks around them.
TEST_F(Import, SdfIsReadAsGazeboReadsIt) {
  const std::string box = "<collision name=\"c\"><geometry><box><size>1 1 1</size></box></geometry></collision>";
  for (const std::string yes : {"true", "True", " TRUE\n", "1"}) {
    const std::string text =
        sdf("<model name=\"m\"><static>" + yes + "</static><link name=\"a\">" + box + "</link></model>");
    EXPECT_FALSE(scene_of(good("w.sdf", text)).bodies.at(0).dynamic) << yes;
    EXPECT_FALSE(
        scene_of(good("r.urdf", urdf(link("a", box_of("1 1 1")) + "<gazebo><static>" + yes + "</static></gazebo>")))
            .bodies.at(0)
            .dynamic)
        << yes;
  }
  const ImportedScene turned =
      good("w.sdf",
           sdf("<model name=\"m\"><pose degrees=\"True\">0 0 0 0 0 180</pose><link name=\"a\">" + box +
               "</link><link name=\"b\">" + box +
               "</link><joint name=\"j\" type=\"fixed\"><parent>\n a\n</parent><child> b </child></joint></model>"));
  const Scene scene = scene_of(turned);
  ASSERT_EQ(scene.bodies.size(), 1U);
  EXPECT_LT((scene.bodies[0].pose.rotation * Vec3::UnitX() + Vec3::UnitX()).norm(), 1e-9);
}

TEST_F(Import, AStaticModelWithinOneThatMovesStands) {
  const std::string box = "<collision name=\"c\"><geometry><box><size>1 1 1</size></box></geometry></collision>";
  const Scene scene = scene_of(good("w.sdf", sdf("<model name=\"m\"><link name=\"a\">" + box +
                                                 "</link><model name=\"n\"><static>true</static><link name=\"b\">" +
                                                 box + "</link></model></model>")));
  ASSERT_EQ(scene.bodies.size(), 2U);
  EXPECT_TRUE(scene.bodies[0].dynamic);
  EXPECT_FALSE(scene.bodies[1].dynamic);
}

// Boxes of 1, 0.5 and 2 m^3.
TEST_F(Import, MassesThatSdfLeavesToDensitiesAreThoseOfTheShapes) {
  const auto shape = [](const std::string& size, const std::string& density) {
    return "<collision name=\"" + size + "\"><pose>9 0 0 0.3 0 0</pose>" + density + "<geometry><box><size>" + size +
           "</size></box></geometry></collision>";
  };
  const std::string three =
      shape("1 1 1", "<density>500</density>") + shape("1 1 0.5", "") + shape("2 1 1", "<density>10</density>");
  const auto mass_of = [&](const std::string& inertial) {
    const std::string text = sdf("<model name=\"m\"><link name=\"a\">" + inertial + three + "</link></model>");
    return scene_of(good("w.sdf", text)).bodies.at(0).mass.mass_kg;
  };
  EXPECT_NEAR(mass_of("<inertial auto=\"true\"/>"), 500.0 + 0.5 * 1000.0 + 20.0, 1e-9);
  EXPECT_NEAR(mass_of("<inertial auto=\"true\"><density>4</density></inertial>"), 500.0 + 2.0 + 20.0, 1e-9);
  EXPECT_EQ(mass_of("<inertial auto=\"true\"><mass>7</mass></inertial>"), 7.0);
  EXPECT_EQ(mass_of("<inertial/>"), 1.0);
}

// As a mesh does whose file has its corners in the other order: its mass went missing without a word, and with no other
// shape beside it the link's density, too.
TEST_F(Import, MassesByDensityDoNotDependOnTheWayAMeshFaces) {
  const auto cube = mesh::made::make_shape("made:box:x=1,y=1,z=1");
  ASSERT_TRUE(cube.ok());
  std::vector<mesh::Triangle> turned(cube.value().triangles().begin(), cube.value().triangles().end());
  for (mesh::Triangle& t : turned) std::swap(t[1], t[2]);
  const auto inside_out = mesh::TriangleMesh::make({cube.value().vertices().begin(), cube.value().vertices().end()},
                                                   std::move(turned), "inside out");
  ASSERT_TRUE(inside_out.ok());
  ASSERT_FALSE(mesh::write(inside_out.value(), folder_.path() / "cube.obj"));
  const std::string mesh = "<collision name=\"c\"><geometry><mesh><uri>cube.obj</uri></mesh></geometry></collision>";
  const std::string box = "<collision name=\"d\"><geometry><box><size>1 1 2</size></box></geometry></collision>";
  for (const auto& [shapes, mass_kg] : {std::pair{mesh, 500.0}, std::pair{mesh + box, 1500.0}}) {
    const ImportedScene imported = good(
        "w.sdf", sdf("<model name=\"m\"><link name=\"a\"><inertial auto=\"true\"><density>500</density></inertial>" +
                     shapes + "</link></model>"));
    EXPECT_NEAR(scene_of(imported).bodies.at(0).mass.mass_kg, mass_kg, 1e-9);
    EXPECT_FALSE(assumes(imported, "'m::a' has no mass: its density is 1000 kg/m^3"));
    EXPECT_FALSE(assumes(imported, "1 meshes whose densities give masses are not closed"));
  }
  std::ofstream(folder_.path() / "cube.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
  const ImportedScene open =
      good("w.sdf", sdf("<model name=\"m\"><link name=\"a\"><inertial auto=\"true\"/>" + mesh + "</link></model>"));
  EXPECT_TRUE(assumes(open, "1 meshes whose densities give masses are not closed"));
}

// What xacro has made of a robot keeps its namespace.
TEST_F(Import, TakesWhatXacroHasMade) {
  const ImportedScene imported = good("r.urdf", "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">" +
                                                    link("a", box_of("1 1 1")) + "</robot>");
  EXPECT_EQ(imported.bodies, 1U);
}

TEST_F(Import, WhatAUrdfTellsGazeboIsReadOrCounted) {
  const ImportedScene imported =
      good("r.urdf", urdf(link("a", box_of("1 1 1")) + "<gazebo reference=\"a\"><mu1>0.4</mu1><material>Red</material>"
                                                       "</gazebo><gazebo><plugin name=\"p\"/></gazebo>"));
  EXPECT_TRUE(assumes(imported, "left out: 1 <material>, 1 <plugin>"));
  EXPECT_NE(imported.text.find("mu = 0.4"), std::string::npos);
}

TEST_F(Import, ALinkNamedWorldStandsWithWhatHangsOnIt) {
  const std::string text =
      urdf(link("world", box_of("4 4 0.1")) + link("base", box_of("1 1 1")) + link("arm", box_of("0.1 0.1 0.1")) +
           R"(<joint name="bolted" type="fixed"><parent link="world"/><child link="base"/><origin xyz="0 0 1"/></joint>
         <joint name="elbow" type="revolute"><parent link="base"/><child link="arm"/></joint>)");
  const Scene scene = scene_of(good("r.urdf", text));
  ASSERT_EQ(scene.bodies.size(), 2U);
  for (const Body& body : scene.bodies) EXPECT_FALSE(body.dynamic) << body.name;
}

// x, y, z of the box go to x, z, -y of the link.
TEST_F(Import, UrdfOriginsMayHaveQuaternions) {
  const ImportedScene imported =
      good("r.urdf", urdf(link("a", box_of("0.1 0.2 0.4",
                                           "<origin xyz=\"1 2 3\" quat_xyzw=\"0.70710678118654757 0 0 "
                                           "0.70710678118654757\"/>"))));
  expect_box(imported.meshes.at(0).mesh, {0.95, 1.8, 2.9}, {1.05, 2.2, 3.1}, 1e-12);
}

TEST_F(Import, MotionCanBeAskedFor) {
  ImportOptions options;
  options.motion = ImportMotion::fixed;
  const std::string text = urdf(link("a", box_of("1 1 1")));
  EXPECT_FALSE(scene_of(good("r.urdf", text, options)).bodies[0].dynamic);
  options.motion = ImportMotion::dynamic;
  const ImportedScene imported = good("r.urdf", text, options);
  EXPECT_TRUE(scene_of(imported).bodies[0].dynamic);
  EXPECT_TRUE(assumes(imported, "'r::a' has no mass: its density is 1000 kg/m^3"));
}

TEST_F(Import, RefusesWithPlaceAndRemedy) {
  const std::string a = link("a", box_of("1 1 1"));
  const auto joint = [](const std::string& type, const std::string& parent, const std::string& child) {
    return "<joint name=\"j" + parent + child + "\" type=\"" + type + "\"><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/></joint>\n";
  };
  const std::vector<std::array<std::string, 3>> cases = {
      {urdf(link("a", box_of("1 nan 1"))), "3:", "is not a finite number"},
      {urdf(link("a", box_of("1 1"))), "3:", "size has 2 numbers, not 3"},
      {urdf(link("a", box_of("1 1 1 1"))), "3:", "size has more numbers, not 3"},
      {urdf(link("a", box_of("1 1 -1"))), "3:", "size is not greater than 0"},
      {urdf(link("a", box_of("1 1 1e13"))), "3:", "beyond 1e12"},
      {urdf(link("a", box_of("1,1,1"))), "3:", "is not a finite number"},
      {urdf(link("a", box_of("1 +-5 1"))), "3:", "'+-5' is not a finite number"},
      {urdf(link("a", box_of("1 1e-400 1"))), "3:", "'1e-400' is too small or too large"},
      {urdf(link("a", box_of("1 1e400 1"))), "3:", "'1e400' is too small or too large"},
      {urdf(a + a), "4:", "a second link named 'a'"},
      {urdf(a + link("b", "")), "2:", "the links 'a' and 'b' have no parent both"},
      {urdf(a + "\n" + joint("fixed", "a", "arm")), "5:", "there is no link named 'arm'"},
      {urdf(a + joint("sliding", "a", "a")), "4:", "the joint type 'sliding' is not known"},
      {urdf(a + link("b", "") + joint("fixed", "a", "b") + joint("fixed", "b", "a")), "2:", "joints lead in a circle"},
      {urdf(a + link("b", "") + joint("fixed", "a", "b") + joint("fixed", "a", "b")), "6:", "has two parents"},
      {urdf(link("a", "<collision><geometry><cone/></geometry></collision>")),
       "3:", "the geometry 'cone' is not known"},
      {urdf(link("a", "<collision/>")), "3:", "<collision> lacks the element <geometry>"},
      {urdf(link("a", "")), "", "no link has collision geometry"},
      {urdf(""), "2:", "the robot has no link"},
      {"<robot>\n<link name=\"a\">\n</robot>", "3:", "not valid XML"},
      {"", "", "not valid XML"},
      {"<mujoco/>", "1:", "<mujoco> is no description that is known"},
      {"<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:include filename=\"a\"/></robot>",
       "2:", "is a xacro file"},
      {"<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<link name=\"${side}_arm\"/></robot>",
       "2:", "is a xacro file"},
      {urdf(link("a", box_of("1 1 1", "<origin rpy=\"0 0 0\" quat_xyzw=\"0 0 0 1\"/>"))), "3:", "both 'rpy' and"},
      {urdf(link("a", box_of("1 1 1", "<origin quat_xyzw=\"0 0 0 2\"/>"))), "3:", "is no rotation"},
      {urdf(a + "<gazebo><static>yes</static></gazebo>"), "4:", "'yes' is neither true nor false"},
      {sdf("<model name=\"m\"><static>yes</static><link name=\"a\"/></model>"), "2:", "'yes' is neither true nor"},
      {urdf(link("a", "<collision><geometry><mesh filename=\"no.stl\"/></geometry></collision>")),
       "3:", "the mesh 'no.stl' is not there"},
      {urdf(link("a", "<collision><geometry><mesh filename=\"package://no/no.stl\"/></geometry></collision>")),
       "3:", "the mesh 'package://no/no.stl' is not there"},
      {urdf(link("a", "<collision><geometry><mesh filename=\"https://x/y.stl\"/></geometry></collision>")),
       "3:", "addresses of this kind are not followed"},
      {sdf("<model name=\"m\"><link name=\"a\"><pose relative_to=\"b\"/></link></model>"), "2:", "there is no frame"},
      {sdf("<model name=\"m\"><link name=\"a\"><pose relative_to=\"b\"/></link>\n<link name=\"b\"><pose "
           "relative_to=\"a\"/></link></model>"),
       "2:", "leads back to itself"},
      {sdf("<model name=\"m\"><link name=\"a\"><pose>1 2 3</pose></link></model>"), "2:", "pose has 3 numbers, not 6"},
      {sdf("<model name=\"m\"></model>"), "2:", "the model 'm' has no link"},
      {sdf("<model name=\"m\"><link name=\"a\"/></model>\n<model name=\"m\"><link name=\"a\"/></model>"),
       "3:", "a second frame named 'm'"},
      {sdf(""), "1:", "there is no model"}};
  for (const auto& [text, place, what] : cases) {
    const Error error = refused("bad.xml", text);
    EXPECT_EQ(error.place.rfind(place, 0), 0U) << error.message() << "\n" << text;
    EXPECT_NE(error.what.find(what), std::string::npos) << error.message() << "\n" << text;
  }
  std::ofstream(folder_.path() / "x.dae") << "x";
  EXPECT_NE(
      refused("bad.xml", urdf(link("a", "<collision><geometry><mesh filename=\"x.dae\"/></geometry></collision>")))
          .what.find("dae files are not read"),
      std::string::npos);
}

TEST_F(Import, SaysWhereWhatIsMissingMayBeIncluded) {
  const std::string include = "<include><uri>model://ground_plane</uri></include>";
  for (const std::string& text : {sdf("<world name=\"w\">" + include + "</world>"), sdf(include),
                                  sdf("<model name=\"m\">" + include + "</model>")}) {
    const Error error = refused("w.sdf", text);
    EXPECT_NE(error.what.find(", and what it includes is not read"), std::string::npos) << error.message();
    EXPECT_NE(error.remedy.find("gz sdf -p"), std::string::npos) << error.message();
  }
  EXPECT_EQ(refused("w.sdf", sdf("<model name=\"m\"/>")).remedy, "add a <link>");
}

TEST_F(Import, SuggestsTheNameThatWasMeant) {
  const std::string text =
      urdf(link("forearm", box_of("1 1 1")) + link("hand", "") +
           "<joint name=\"j\" type=\"fixed\"><parent link=\"forarm\"/><child link=\"hand\"/></joint>");
  EXPECT_EQ(refused("r.urdf", text).remedy, "did you mean 'forearm'?");
}

}  // namespace
}  // namespace odds::scene
