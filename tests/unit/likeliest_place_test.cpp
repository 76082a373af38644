// Where the most probable pair of cells says that surfaces meet, when a query ends before it is decided.
#include <gtest/gtest.h>

#include <cmath>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> made(const std::string& name) {
  auto mesh = mesh::made::make_shape("made:" + name);
  EXPECT_TRUE(mesh.ok());
  return std::move(Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()))).value();
}

/// Bricks that lie on each other with faces in one plane and edges flush: no box parts them, and no triangle crosses.
TEST(LikeliestPlace, OfABrickOnABrickPushesStraight) {
  int guessed = 0;
  for (const int cells : {8, 11}) {
    const auto brick = made("box:x=0.203,y=0.1,z=0.057,cells=" + std::to_string(cells));
    for (const double apart : {1e-16, 1e-15, 1e-12}) {
      for (const std::uint64_t units : {100, 400, 1000, 2000}) {
        auto pair = std::move(Pair::make(brick, brick)).value();
        const math::Pose above{Mat3::Identity(), Vec3(0, 0, 0.057 + apart)};
        const Answer& answer =
            pair.run(above, {.method = Method::incremental, .budget = Budget::work(units), .max_contacts = 8});
        if (answer.basis == Basis::proved || !answer.has_cell_pair) continue;
        ++guessed;
        EXPECT_LT(answer.cell_pair.normal.z(), -0.9) << cells << " cells, " << units << " units, " << apart << " m";
      }
    }
  }
  EXPECT_GT(guessed, 10);
}

}  // namespace
}  // namespace odds::query
