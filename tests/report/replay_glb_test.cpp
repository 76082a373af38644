// The run as GLB: read back by a reader that is not ours, where that is installed, and bit by bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "odds/mesh/made/by_name.hpp"
#include "odds/report/replay_glb.hpp"
#include "report/glb_builder.hpp"
#include "report/made_recording.hpp"

#ifdef ODDS_HAS_TINYGLTF
#include <tiny_gltf.h>
#endif

namespace odds::report {
namespace {

constexpr double far = 5e5;  // metres from the origin, where floats are 3 cm coarse

RunReplay made_replay() {
  const auto ball = mesh::made::make_shape("made:icosphere:radius=0.02,frequency=4");
  const auto plate = mesh::made::make_shape("made:box:x=0.2,y=0.2,z=0.02");
  RunReplay replay;
  replay.meshes = {simplified(ball.value(), 20'000), simplified(plate.value(), 20'000)};
  math::Pose there;
  there.translation.x() = far;
  replay.bodies = {{"plate \"x\" \xff", 1, false, false, there}, {"tool", 0, true, true, there}};
  for (std::uint64_t tick = 0; tick < 1000; tick += 10) {
    math::Pose pose = there;
    pose.translation.z() = 0.03 + 0.001 * std::sin(0.01 * static_cast<double>(tick));
    pose.rotation = Eigen::AngleAxisd(0.01 * static_cast<double>(tick), Vec3::UnitY()).toRotationMatrix();
    ReplayFrame frame{tick, {pose}, {}};
    if (tick >= 500) frame.marks.push_back({there * Vec3(0, 0, 0.01), Vec3::UnitZ(), 1e-4, 1.0, false});
    replay.frames.push_back(std::move(frame));
  }
  return replay;
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

TEST(ReplayGlb, HasTheLayoutOfItsSpecification) {
  const MadeRecording made = made_recording(1.0);
  const std::string file = replay_glb(made.info, made_replay(), made.ticks).value();
  ASSERT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(number_at(file, 4), 2U);
  EXPECT_EQ(number_at(file, 8), file.size());
  const std::size_t json_size = number_at(file, 12);
  EXPECT_EQ(file.substr(16, 4), "JSON");
  EXPECT_EQ(json_size % 4, 0U);
  const std::size_t binary = 20 + json_size;
  EXPECT_EQ(file.substr(binary + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(binary + 8 + number_at(file, binary), file.size());
  const auto json = nlohmann::json::parse(file.substr(20, json_size));
  for (const auto& view : json.at("bufferViews")) {
    EXPECT_EQ(view.at("byteOffset").get<std::size_t>() % 4, 0U);
    EXPECT_LE(view.at("byteOffset").get<std::size_t>() + view.at("byteLength").get<std::size_t>(),
              json.at("buffers")[0].at("byteLength").get<std::size_t>());
  }
  for (const auto& mesh : json.at("meshes")) {
    const auto& position = json.at("accessors")[mesh["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(position.at("min").size(), 3U);
    EXPECT_EQ(position.at("max").size(), 3U);
  }
}

std::vector<query::UpperBox> boxes_of(const std::string& name) {
  const auto mesh = std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value());
  return query::upper_boxes(*query::Shape::build(mesh).value(), 200);
}

TEST(ReplayGlb, DrawsTheFrontWhereBoxesOverlapAndOnlyThere) {
  const MadeRecording made = made_recording(1.0);
  RunReplay replay = made_replay();
  replay.meshes[0].boxes = boxes_of("made:icosphere:radius=0.02,frequency=4");
  replay.meshes[1].boxes = boxes_of("made:box:x=0.2,y=0.2,z=0.02");
  for (std::size_t i = 0; i < replay.frames.size(); ++i) {
    if (i >= replay.frames.size() / 2) replay.frames[i].poses[0].translation.z() += 1.0;
  }
  const std::string file = replay_glb(made.info, replay, made.ticks).value();
  const auto json = nlohmann::json::parse(file.substr(20, number_at(file, 12)));
  std::size_t boxes = 0;
  std::size_t front = 0;
  for (std::size_t i = 0; i < json.at("nodes").size(); ++i) {
    const auto& node = json["nodes"][i];
    if (node.value("name", "") != "front") continue;
    ++boxes;
    front = i;
    EXPECT_EQ(json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0]["mode"], 1) << "lines";
  }
  ASSERT_GE(boxes, 2U) << "one of each body at least";
  const auto& animation = json.at("animations")[0];
  std::size_t shown = 0;
  std::size_t seen = 0;
  for (const auto& channel : animation.at("channels")) {
    if (channel["target"]["node"] != front || channel["target"]["path"] != "scale") continue;
    const auto& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
    EXPECT_EQ(sampler["interpolation"], "STEP");
    const auto& scales = json["accessors"][sampler["output"].get<std::size_t>()];
    const std::size_t at =
        20 + number_at(file, 12) + 8 +
        json["bufferViews"][scales["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
    for (std::size_t i = 0; i < replay.frames.size(); ++i) {
      float scale = 0.0F;
      std::memcpy(&scale, file.data() + at + 12 * i, sizeof scale);
      if (scale > 1e-5F) ++(i < replay.frames.size() / 2 ? shown : seen);
    }
  }
  EXPECT_GT(shown, 0U);
  EXPECT_EQ(seen, 0U) << "of a ball a metre above the plate";
}

TEST(ReplayGlb, AnEmptyRunIsAFileToo) {
  const MadeRecording made;
  RunReplay replay = made_replay();
  replay.frames.clear();
  const std::string file = replay_glb(made.info, replay, {}).value();
  EXPECT_EQ(number_at(file, 8), file.size());
  EXPECT_EQ(file.find("animations"), std::string::npos);
}

TEST(ReplayGlb, AFileThatItsHeaderCannotMeasureIsRefused) {
  GlbBuilder builder;
  builder.floats(std::vector<float>{1.0F, 2.0F, 3.0F}, 1);
  const std::size_t size = builder.file().value().size();
  EXPECT_EQ(size % 4, 0U);
  EXPECT_EQ(builder.file(size).value().size(), size);
  const auto refused = builder.file(size - 1);
  ASSERT_FALSE(refused.ok());
  EXPECT_FALSE(refused.error().remedy.empty());
  EXPECT_EQ(GlbBuilder::largest_file, 0xffffffffU);
}

#ifdef ODDS_HAS_TINYGLTF

class ReplayGlbRead : public ::testing::Test {
 protected:
  void SetUp() override {
    const MadeRecording made = made_recording(1.0);
    const std::string file = replay_glb(made.info, made_replay(), made.ticks).value();
    std::string error;
    std::string warning;
    tinygltf::TinyGLTF reader;
    ASSERT_TRUE(reader.LoadBinaryFromMemory(&model, &error, &warning,
                                            reinterpret_cast<const unsigned char*>(file.data()),
                                            static_cast<unsigned>(file.size())))
        << error;
    EXPECT_EQ(error, "");
    EXPECT_EQ(warning, "");
  }
  const float* numbers(int accessor) const {
    const tinygltf::Accessor& a = model.accessors.at(static_cast<std::size_t>(accessor));
    const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(a.bufferView));
    return reinterpret_cast<const float*>(model.buffers.at(0).data.data() + view.byteOffset + a.byteOffset);
  }
  int node(const std::string& name) const {
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
      if (model.nodes[i].name == name) return static_cast<int>(i);
    }
    ADD_FAILURE() << "no node " << name;
    return 0;
  }
  /// The sampler that moves this part of a node.
  const tinygltf::AnimationSampler& sampler(const std::string& name, const std::string& path) const {
    for (const tinygltf::AnimationChannel& channel : model.animations.at(0).channels) {
      if (channel.target_node == node(name) && channel.target_path == path) {
        return model.animations[0].samplers.at(static_cast<std::size_t>(channel.sampler));
      }
    }
    ADD_FAILURE() << name << " has no " << path;
    return model.animations.at(0).samplers.at(0);
  }
  tinygltf::Model model;
};

TEST_F(ReplayGlbRead, BodiesMoveAsInTheRun) {
  const tinygltf::AnimationSampler& moved = sampler("tool", "translation");
  const tinygltf::AnimationSampler& turned = sampler("tool", "rotation");
  ASSERT_EQ(model.accessors.at(static_cast<std::size_t>(moved.output)).count, 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    const double tick = 10.0 * static_cast<double>(i);
    EXPECT_NEAR(numbers(moved.input)[i], 0.001 * tick, 1e-6);
    EXPECT_NEAR(numbers(moved.output)[3 * i], 0.0, 1e-9);  // told from the plate's place, 500 km away
    EXPECT_NEAR(numbers(moved.output)[3 * i + 2], 0.03 + 0.001 * std::sin(0.01 * tick), 1e-7);
    const float* q = numbers(turned.output) + 4 * i;
    EXPECT_NEAR(std::abs(q[1]), std::abs(std::sin(0.005 * tick)), 1e-5);
    if (i > 0) {
      EXPECT_GT(q[-4] * q[0] + q[-3] * q[1] + q[-2] * q[2] + q[-1] * q[3], 0.9F);
    }
  }
}

TEST_F(ReplayGlbRead, TheWorldTurnsUpToGltfsUp) {
  const tinygltf::Node& world = model.nodes.at(static_cast<std::size_t>(model.scenes.at(0).nodes.at(0)));
  EXPECT_EQ(world.name, "world");
  const Quat turn(world.rotation[3], world.rotation[0], world.rotation[1], world.rotation[2]);
  EXPECT_LT((turn * Vec3::UnitZ() - Vec3::UnitY()).norm(), 1e-9);
  EXPECT_NEAR(world.extras.Get("origin_m").Get(0).GetNumberAsDouble(), far, 1e-9);
  EXPECT_EQ(world.children.size() + 1, model.nodes.size());
}

TEST_F(ReplayGlbRead, MeshesAreThoseOfTheBodies) {
  const RunReplay replay = made_replay();
  const tinygltf::Node& tool = model.nodes.at(static_cast<std::size_t>(node("tool")));
  const tinygltf::Primitive& shape = model.meshes.at(static_cast<std::size_t>(tool.mesh)).primitives.at(0);
  EXPECT_EQ(model.accessors.at(static_cast<std::size_t>(shape.indices)).count, 3 * replay.meshes[0].triangles.size());
  const int position = shape.attributes.at("POSITION");
  EXPECT_EQ(model.accessors.at(static_cast<std::size_t>(position)).count, replay.meshes[0].vertices.size());
  EXPECT_NEAR(Vec3(numbers(position)[0], numbers(position)[1], numbers(position)[2]).norm(), 0.02, 1e-6);
}

TEST_F(ReplayGlbRead, MarksShowOnlyWhereTheyAre) {
  const tinygltf::AnimationSampler& size = sampler("contact", "scale");
  EXPECT_EQ(size.interpolation, "STEP");
  EXPECT_LT(numbers(size.output)[3 * 49], 1e-5F);
  EXPECT_GT(numbers(size.output)[3 * 50], 1e-3F);
  EXPECT_NEAR(numbers(sampler("contact", "translation").output)[3 * 60 + 2], 0.01, 1e-7);
}

TEST_F(ReplayGlbRead, TheArrowIsLongestAtTheGreatestForce) {
  const tinygltf::AnimationSampler& size = sampler("force on the hand", "scale");
  float longest = 0.0F;
  for (std::size_t i = 0; i < 100; ++i) longest = std::max(longest, numbers(size.output)[3 * i]);
  EXPECT_GT(longest, 0.01F);
}

#else

TEST(ReplayGlbRead, Skipped) { GTEST_SKIP() << "tinygltf is not installed (Debian: libtinygltf-dev)"; }

#endif

}  // namespace
}  // namespace odds::report
