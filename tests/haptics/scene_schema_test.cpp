// The published schema and the reader of scenes say the same: the same keys, the same types, the same bounds.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "haptics/scene_document.hpp"
#include "odds/haptics/device_registry.hpp"
#include "odds/haptics/effect_registry.hpp"
#include "odds/haptics/motion.hpp"
#include "odds/haptics/scripted_device.hpp"
#include "odds/scene/scene.hpp"
#include "scene/toml_settings.hpp"
#include "support/temporary_folder.hpp"

namespace odds::scene {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::set<std::string>;
using testing::contents_of;
using testing::TemporaryFolder;

const std::filesystem::path source = ODDS_SOURCE_DIR;

const nlohmann::json& schema_json() {
  static const nlohmann::json json = nlohmann::json::parse(contents_of(source / "docs/scene.schema.json"));
  return json;
}

struct PublishedSchema {
  PublishedSchema() {
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_json()), schema);
  }
  valijson::Schema schema;
};

/// Whether a document fits the schema; judged by a validator that is not ours.
bool fits(const Json& document) {
  static const PublishedSchema published;
  const nlohmann::json plain = nlohmann::json::parse(document.dump());
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  return validator.validate(published.schema, valijson::adapters::NlohmannJsonAdapter(plain), nullptr);
}

class SceneSchema : public ::testing::Test {
 protected:
  SceneSchema() { folder_.write("track.csv", "t_ns,px_m,py_m,pz_m,qw,qx,qy,qz\n0,0,0,0.1,1,0,0,0\n"); }
  [[nodiscard]] std::optional<Error> refusal(const Json& document) const {
    const auto scene = parse_scene(toml_document(document), "probe.toml", folder_.path());
    if (scene.ok()) return std::nullopt;
    return scene.error();
  }
  /// The keys that the reader knows in the table at `at`: it lists them when it is given one that is like none.
  [[nodiscard]] Names known_to_reader(Json document, const Json::json_pointer& at) const {
    document[at]["Z9_Z9_Z9_Z9_Z9_Z9"] = 1;
    const auto error = refusal(document);
    if (!error || error->what.find("unknown key 'Z9_Z9") == std::string::npos) {
      ADD_FAILURE() << at << ": " << (error ? error->message() : "an unknown key was accepted");
      return {};
    }
    Names names;
    std::string list = error->remedy;
    EXPECT_EQ(list.rfind("valid are ", 0), 0U) << list;
    list.erase(0, std::min<std::size_t>(list.size(), 10));
    if (const std::size_t last = list.rfind(" or "); last != std::string::npos) list.replace(last, 4, ", ");
    std::istringstream words(list);
    for (std::string word; words >> word;) names.insert(word.back() == ',' ? word.substr(0, word.size() - 1) : word);
    return names;
  }

  TemporaryFolder folder_;
};

/// A scene in which every table can stand; `device` and `effects` are added by the case.
Json base() {
  return Json::parse(R"({
    "format": "odds.scene/1", "search": ["meshes"],
    "loop": {"rate_hz": 1000}, "query": {"budget_us": 50, "frame_us": 500, "p_min": 0.99}, "physics": {"solver": "iterative", "iterations": 30},
    "mesh": [{"name": "block", "file": "made:box"}],
    "body": [{"name": "floor", "mesh": "block"},
             {"name": "loose", "mesh": "block", "motion": "dynamic", "mass_kg": 1.0}],
    "effects": {"contact": {}, "friction": {"mu": 0.5}}})");
}

Json held(const std::string& type) {
  Json document = base();
  document["device"]["hand"]["type"] = type;
  if (type == "replay") document["device"]["hand"]["file"] = "track.csv";
  document["body"].push_back(
      {{"name", "tool"}, {"mesh", "block"}, {"motion", "dynamic"}, {"mass_kg", 0.1}, {"device", "hand"}});
  document["effects"]["virtual_coupling"] = Json::object();
  return document;
}

/// What a table cannot do without, beside the base.
const std::map<std::string, std::string> required_keys = {
    {"hold", R"({})"},
    {"press", R"({"depth_m": 0.01})"},
    {"slide", R"({"by_m": [0.0, 0.0, 0.1]})"},
    {"tap", R"({"depth_m": 0.01})"},
    {"sine", R"({"amplitude_m": 0.01, "frequency_hz": 10.0})"},
    {"spiral", R"({"radius_m": 0.01})"},
    {"viscosity", R"({"drag_ns_per_m": 1.0})"},
    {"attraction", R"({"body": "loose", "to": "floor", "max_force_n": 1.0, "range_m": 0.1})"},
    {"snap",
     R"({"body": "loose", "anchor": "floor", "capture_m": 0.01, "stiffness_n_per_m": 10.0, "break_force_n": 1.0})"},
    {"compliance", R"({"body": "loose", "stiffness_n_per_m": 100.0})"},
    {"texture", R"({"body": "floor", "amplitude_m": 0.0001, "wavelength_m": 0.01})"},
    {"surface_velocity", R"({"body": "floor", "velocity_m_per_s": [1.0, 0.0, 0.0]})"},
    {"friction", R"({"mu": 0.5})"},
    {"rolling_friction", R"({"rolling_m": 0.001})"},
    {"restitution", R"({"coefficient": 0.5})"}};

Json with_required_keys(const std::string& name) {
  const auto found = required_keys.find(name);
  return Json::parse(found == required_keys.end() ? "{}" : found->second);
}

/// A table of a scene: where it stands in a document that is good as it is, and its place in the schema.
struct Table {
  Json document;
  Json::json_pointer at;
  std::string definition;  ///< "" for the top
};

std::vector<Table> all_tables() {
  using Pointer = Json::json_pointer;
  std::vector<Table> tables = {{base(), Pointer(""), ""},
                               {base(), Pointer("/loop"), "loop"},
                               {base(), Pointer("/query"), "query"},
                               {base(), Pointer("/physics"), "physics"},
                               {base(), Pointer("/mesh/0"), "mesh"},
                               {base(), Pointer("/body/0"), "body"},
                               {base(), Pointer("/body/1"), "body"},
                               {base(), Pointer("/effects"), "effects"}};
  for (const std::string& type : haptics::device_names()) {
    tables.push_back({held(type), Pointer("/device/hand"), "device_" + type});
  }
  for (const std::string_view kind : haptics::motion_names) {
    Json document = held("scripted");
    Json motion = with_required_keys(std::string(kind));
    motion["kind"] = kind;
    motion["duration_s"] = 1.0;
    document["device"]["hand"]["motion"] = Json::array({motion});
    tables.push_back({document, Pointer("/device/hand/motion/0"), "motion_" + std::string(kind)});
  }
  for (const haptics::EffectType& type : haptics::effect_types()) {
    const std::string name(type.name);
    Json document = held("null");
    document["effects"][name] = with_required_keys(name);
    tables.push_back({document, Pointer("/effects/" + name), "effect_" + name});
  }
  return tables;
}

const nlohmann::json& definition_of(const Table& table) {
  return table.definition.empty() ? schema_json() : schema_json().at("definitions").at(table.definition);
}

TEST_F(SceneSchema, TheDocumentsThatTheseTestsChangeAreGoodForBoth) {
  for (const Table& table : all_tables()) {
    const auto error = refusal(table.document);
    EXPECT_FALSE(error) << table.definition << ": " << error->message();
    EXPECT_TRUE(fits(table.document)) << table.definition << "\n" << table.document;
  }
}

TEST_F(SceneSchema, HasTheKeysThatTheReaderKnowsAndNoOthers) {
  for (const Table& table : all_tables()) {
    Names in_schema;
    for (const auto& [key, what] : definition_of(table).at("properties").items()) in_schema.insert(key);
    EXPECT_EQ(in_schema, known_to_reader(table.document, table.at)) << table.definition;
    EXPECT_EQ(definition_of(table).at("additionalProperties"), false) << table.definition;
  }
}

TEST_F(SceneSchema, HasEveryDefinitionInUse) {
  Names tables = {"number", "motion", "device_other"};
  for (const Table& table : all_tables()) tables.insert(table.definition);
  for (const auto& [name, what] : schema_json().at("definitions").items()) EXPECT_TRUE(tables.contains(name)) << name;
}

/// A refusal that only a schema's means are needed for.
bool about_one_key(const Error& error) {
  for (const char* mark : {"out of range", ", not ", "beyond 1e12", "cannot be '", "is empty", "lacks the key",
                           "numbers, not", "has no direction"}) {
    if (error.what.find(mark) != std::string::npos) return true;
  }
  return false;
}

// Bounds that depend on another key, and a rule on the length of a quaternion, are beyond a schema.
bool beyond_schemas(const Error& error) {
  for (const char* mark : {"'frequency_hz'", "'rise_s'", "is not a rotation"}) {
    if (error.what.find(mark) != std::string::npos) return true;
  }
  return false;
}

/// Values on both sides of each bound that the schema states, and of every type.
std::vector<Json> probes_of(nlohmann::json what) {
  if (what.contains("$ref"))
    what = schema_json().at(nlohmann::json::json_pointer(what["$ref"].get<std::string>().substr(1)));
  std::vector<Json> probes = {true,
                              "x",
                              "",
                              0.5,
                              0.0,
                              -1.0,
                              2e12,
                              -2e12,
                              Json::array(),
                              Json::object(),
                              Json::array({1.0, 0.0, 0.0}),
                              Json::array({0.0, 0.0, 0.0}),
                              Json::array({1.0, "x", 0.0}),
                              Json::array({1.0, 0.0, 0.0, 0.0}),
                              Json::array({2e12, 0.0, 0.0})};
  const bool whole = what.value("type", "") == "integer";
  for (const char* bound : {"minimum", "exclusiveMinimum", "maximum"}) {
    if (!what.contains(bound)) continue;
    const nlohmann::json& at = what[bound];
    if (whole) {
      const auto number = at.get<std::int64_t>();
      for (const std::int64_t step : {-1, 0, 1}) {
        if (number != std::numeric_limits<std::int64_t>::max() || step < 1) probes.push_back(number + step);
      }
    } else {
      const auto number = at.get<double>();
      const double step = std::max(1e-12, 1e-9 * std::abs(number));
      for (const double value : {number - step, number, number + step}) probes.push_back(value);
    }
  }
  for (const auto& name : what.value("enum", nlohmann::json::array())) probes.push_back(Json(name));
  return probes;
}

TEST_F(SceneSchema, RefusesAValueWhereTheReaderDoes) {
  int taken = 0;
  int refused = 0;
  for (const Table& table : all_tables()) {
    if (table.definition == "effects") continue;
    for (const auto& [key, what] : definition_of(table).at("properties").items()) {
      for (const Json& probe : probes_of(what)) {
        Json document = table.document;
        document[table.at][key] = probe;
        const auto error = refusal(document);
        const bool good = fits(document);
        const std::string shown = table.definition + "." + key + " = " + probe.dump();
        if (!error) {
          EXPECT_TRUE(good) << shown << ": the reader takes it, the schema does not";
          ++taken;
        } else if (about_one_key(*error) && !beyond_schemas(*error)) {
          const bool whole_written_with_a_point = probe.is_number_float() && what.value("type", "") == "integer";
          EXPECT_TRUE(!good || whole_written_with_a_point) << shown << ": only the reader refuses it: " << error->what;
          ++refused;
        }
      }
    }
  }
  EXPECT_GT(taken, 400);
  EXPECT_GT(refused, 2000);
}

TEST_F(SceneSchema, RefusesATableWithoutAKeyThatTheReaderRequires) {
  for (const Table& table : all_tables()) {
    for (const auto& [key, value] : table.document[table.at].items()) {
      Json document = table.document;
      document[table.at].erase(key);
      const auto error = refusal(document);
      if (!error) {
        EXPECT_TRUE(fits(document)) << table.definition << " without " << key;
      } else if (error->what.find("lacks the key") != std::string::npos ||
                 error->what.find("neither mass nor density") != std::string::npos) {
        EXPECT_FALSE(fits(document)) << table.definition << " without " << key;
      }
    }
  }
}

TEST_F(SceneSchema, RefusesWhatDisagrees) {
  const std::vector<std::pair<const char*, const char*>> disagreeing = {
      {"a made shape with a scale", R"([{"op": "add", "path": "/mesh/0/scale", "value": 2.0}])"},
      {"mass and density", R"([{"op": "add", "path": "/body/1/density_kg_per_m3", "value": 2.0}])"},
      {"a fixed body with a mass", R"([{"op": "add", "path": "/body/0/mass_kg", "value": 2.0}])"},
      {"contacts without points", R"([{"op": "add", "path": "/query/max_contacts", "value": 0}])"},
      {"a strike without a point",
       R"([{"op": "add", "path": "/query/max_contacts", "value": 0},
           {"op": "replace", "path": "/effects", "value": {"virtual_coupling": {}, "vibration": {}}},
           {"op": "add", "path": "/device", "value": {"hand": {"type": "null"}}},
           {"op": "add", "path": "/body/1/device", "value": "hand"}])"},
      {"a threshold of the exact method",
       R"([{"op": "add", "path": "/query/method", "value": "exact"},
           {"op": "add", "path": "/query/p_min", "value": 0.5}])"},
      {"k_min without p_min",
       R"([{"op": "remove", "path": "/query/p_min"}, {"op": "add", "path": "/query/k_min", "value": 20}])"},
      {"iterations of the exact solver", R"([{"op": "remove", "path": "/physics/solver"}])"},
      {"half of the sub-steps", R"([{"op": "add", "path": "/physics/most_substeps", "value": 4}])"},
      {"sub-steps in parts",
       R"([{"op": "add", "path": "/physics/ticks_per_step", "value": 4},
           {"op": "add", "path": "/physics/most_substeps", "value": 4},
           {"op": "add", "path": "/physics/substep_way_m", "value": 0.001}])"},
      {"parts of a step without a limit",
       R"([{"op": "add", "path": "/physics/ticks_per_step", "value": 4}, {"op": "remove", "path": "/query/frame_us"}])"},
      {"a hand and steps in parts",
       R"([{"op": "add", "path": "/physics/ticks_per_step", "value": 4},
           {"op": "add", "path": "/device", "value": {"hand": {"type": "null"}}}])"},
      {"friction without contact", R"([{"op": "remove", "path": "/effects/contact"}])"},
      {"restitution by a penalty",
       R"([{"op": "add", "path": "/effects/contact/law", "value": "penalty"},
           {"op": "add", "path": "/effects/restitution", "value": {"coefficient": 0.5}}])"},
      {"restitution by a penalty, in lists",
       R"([{"op": "replace", "path": "/effects/contact", "value": [{"law": "penalty"}]},
           {"op": "add", "path": "/effects/restitution", "value": [{"coefficient": 0.5}]}])"},
      {"viscous friction by a constraint",
       R"([{"op": "add", "path": "/effects/contact/law", "value": "constraint"},
           {"op": "add", "path": "/effects/friction/viscous_ns_per_m", "value": 0.5}])"},
      {"viscous friction by a constraint, in lists",
       R"([{"op": "replace", "path": "/effects/contact", "value": [{"law": "constraint"}]},
           {"op": "replace", "path": "/effects/friction", "value": [{"mu": 0.5, "viscous_ns_per_m": 0.5}]}])"},
      {"two gravities", R"([{"op": "add", "path": "/effects/gravity", "value": [{}, {}]}])"},
      {"another format", R"([{"op": "replace", "path": "/format", "value": "odds.scene/2"}])"},
      {"no body", R"([{"op": "replace", "path": "/body", "value": []}])"}};
  for (const auto& [what, patch] : disagreeing) {
    const Json document = base().patch(Json::parse(patch));
    EXPECT_TRUE(refusal(document)) << what;
    EXPECT_FALSE(fits(document)) << what;
  }
}

TEST_F(SceneSchema, TakesEffectsThatALawCarries) {
  const std::vector<std::pair<const char*, const char*>> agreeing = {
      {"restitution of a constraint",
       R"([{"op": "add", "path": "/effects/contact/law", "value": "constraint"},
           {"op": "add", "path": "/effects/restitution", "value": {"coefficient": 0.5}}])"},
      {"events without points",
       R"([{"op": "add", "path": "/query/max_contacts", "value": 0},
           {"op": "replace", "path": "/effects", "value": {"events": {}}}])"},
      {"no viscosity in the friction of a constraint",
       R"([{"op": "add", "path": "/effects/contact/law", "value": "constraint"},
           {"op": "add", "path": "/effects/friction/viscous_ns_per_m", "value": 0}])"},
      {"no restitution by a penalty, in a list",
       R"([{"op": "add", "path": "/effects/contact/law", "value": "penalty"},
           {"op": "add", "path": "/effects/restitution", "value": []}])"},
      {"friction of a constraint without the key, in lists",
       R"([{"op": "replace", "path": "/effects/contact", "value": [{"law": "constraint"}]},
           {"op": "replace", "path": "/effects/friction", "value": [{"mu": 0.5}]}])"},
      {"restitution of the law that is taken where none is named",
       R"([{"op": "replace", "path": "/effects/contact", "value": [{}]},
           {"op": "add", "path": "/effects/restitution", "value": {"coefficient": 0.5}}])"},
      {"viscous friction by a penalty",
       R"([{"op": "add", "path": "/effects/contact/law", "value": "penalty"},
           {"op": "add", "path": "/effects/friction/viscous_ns_per_m", "value": 0.5}])"}};
  for (const auto& [what, patch] : agreeing) {
    const Json document = base().patch(Json::parse(patch));
    EXPECT_FALSE(refusal(document)) << what;
    EXPECT_TRUE(fits(document)) << what;
  }
}

TEST_F(SceneSchema, FitsEverySceneOfTheTree) {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"tests/fuzz/seeds", "demos/scenes"}) {
    for (const auto& entry : std::filesystem::directory_iterator(source / folder)) {
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
    }
  }
  EXPECT_GT(files.size(), 9U);
  for (const auto& file : files) {
    const auto settings = parse_toml(contents_of(file), file.string());
    ASSERT_TRUE(settings.ok()) << settings.error().message();
    EXPECT_TRUE(fits(to_json(settings.value()))) << file;
  }
}

TEST_F(SceneSchema, HasTheDefaultsThatThePageStates) {
  // A default that is written out changes nothing.
  for (const Table& table : all_tables()) {
    for (const auto& [key, what] : definition_of(table).at("properties").items()) {
      if (!what.contains("default") || table.document[table.at].contains(key)) continue;
      Json document = table.document;
      document[table.at][key] = what["default"];
      const auto error = refusal(document);
      EXPECT_TRUE(!error || !about_one_key(*error)) << table.definition << "." << key << ": " << error->message();
    }
  }
}

}  // namespace
}  // namespace odds::scene
