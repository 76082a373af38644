#include "benchmark/peer_ode.hpp"

#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>
#include <stdexcept>
#include <vector>

namespace odds::benchmark {
namespace {

/// What ODE has to say of deep overlaps, thousands of times: the first is written, the rest is counted. Writing each
/// would be measured as ODE's time.
class Messages {
 public:
  static void hear(int number, const char* format, va_list arguments) {
    if (count_++ > 0) return;
    std::fprintf(stderr, "ODE message %d: ", number);
    std::vfprintf(stderr, format, arguments);
    std::fputs("\n", stderr);
  }
  static void sum_up() {
    if (count_ > 1) std::fprintf(stderr, "%ld such messages of ODE in all\n", count_);
  }

 private:
  static inline long count_ = 0;
};

struct Library {
  Library() {
    if (dInitODE2(0) == 0 || dAllocateODEDataForThread(dAllocateMaskAll) == 0) throw std::runtime_error("dInitODE2");
    dSetMessageHandler(&Messages::hear);
  }
  ~Library() {
    dCloseODE();
    Messages::sum_up();
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  static void start() { static const Library library; }
};

/// A mesh in ODE's form; ODE reads the arrays, so they live as long as its data.
class TrimeshData {
 public:
  explicit TrimeshData(const mesh::TriangleMesh& mesh)
      : vertices_(mesh.vertices().begin(), mesh.vertices().end()), id_(dGeomTriMeshDataCreate()) {
    for (const mesh::Triangle& t : mesh.triangles()) indices_.insert(indices_.end(), t.begin(), t.end());
    dGeomTriMeshDataBuildDouble(id_, vertices_.data(), sizeof(Vec3), static_cast<int>(vertices_.size()),
                                indices_.data(), static_cast<int>(indices_.size()), 3 * sizeof(dTriIndex));
  }
  ~TrimeshData() { dGeomTriMeshDataDestroy(id_); }
  TrimeshData(const TrimeshData&) = delete;
  TrimeshData& operator=(const TrimeshData&) = delete;
  [[nodiscard]] dTriMeshDataID id() const noexcept { return id_; }

 private:
  std::vector<Vec3> vertices_;
  std::vector<dTriIndex> indices_;
  dTriMeshDataID id_;
};

class OdePeer final : public Peer {
 public:
  OdePeer(const MeshPair& meshes, int contacts, int builds)
      : Peer("ODE dTriMesh"), found_(static_cast<std::size_t>(contacts)) {
    Library::start();
    a_ = build_measured(meshes.a->triangles().size(), builds, [&] { return std::make_shared<TrimeshData>(*meshes.a); });
    b_ = meshes.b == meshes.a ? a_ : std::make_shared<TrimeshData>(*meshes.b);
    geom_a_ = dCreateTriMesh(nullptr, a_->id(), nullptr, nullptr, nullptr);
    geom_b_ = dCreateTriMesh(nullptr, b_->id(), nullptr, nullptr, nullptr);
  }
  ~OdePeer() override {
    dGeomDestroy(geom_a_);
    dGeomDestroy(geom_b_);
  }

  [[nodiscard]] bool collide(const math::Pose& pose_b_in_a) override {
    return run(pose_b_in_a, static_cast<int>(1U | static_cast<unsigned>(CONTACTS_UNIMPORTANT))) != 0;
  }
  [[nodiscard]] std::size_t contacts(const math::Pose& pose_b_in_a) override {
    return static_cast<std::size_t>(run(pose_b_in_a, static_cast<int>(found_.size())));
  }

 private:
  int run(const math::Pose& pose, int flags) {
    dMatrix3 rotation;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) rotation[4 * row + column] = pose.rotation(row, column);
      rotation[4 * row + 3] = 0.0;
    }
    dGeomSetRotation(geom_b_, rotation);
    dGeomSetPosition(geom_b_, pose.translation.x(), pose.translation.y(), pose.translation.z());
    return dCollide(geom_a_, geom_b_, flags, found_.data(), sizeof(dContactGeom));
  }

  std::shared_ptr<TrimeshData> a_;
  std::shared_ptr<TrimeshData> b_;
  dGeomID geom_a_ = nullptr;
  dGeomID geom_b_ = nullptr;
  std::vector<dContactGeom> found_;
};

}  // namespace

std::unique_ptr<Peer> make_ode_peer(const MeshPair& meshes, int contacts, int builds) {
  return std::make_unique<OdePeer>(meshes, contacts, builds);
}

}  // namespace odds::benchmark
