// Contacts of flat faces that lie on each other, of pairs whose budget has no time for a patch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/query/pair.hpp"
#include "support/allocation_counter.hpp"
#include "support/short_request.hpp"
#include "support/slabs.hpp"

namespace odds::query {
namespace {

using testing::below;
using testing::made_mesh;
using testing::short_request;
using testing::slab;

std::shared_ptr<const Shape> shape_of(mesh::TriangleMesh mesh) {
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}

Pair late_pair(const std::shared_ptr<const Shape>& a, const std::shared_ptr<const Shape>& b) {
  return std::move(Pair::make(a, b, {.late_contacts = true})).value();
}

TEST(FlushPair, OfARunAreThoseOfAPatchWithoutALimit) {
  const auto brick = shape_of(slab(10));
  for (const double microseconds : {5.0, 20.0}) {
    realtime::ManualClock clock(50);
    Pair pair = late_pair(brick, brick);
    math::Pose pose = below(1e-5, 0.3);
    pose.translation.x() = 0.2;
    int flush = 0;
    for (int run = 0; run < 40; ++run) {
      const Answer& answer = pair.run(pose, short_request(clock, microseconds));
      if (!answer.contacts_flush) continue;
      ++flush;
      EXPECT_FALSE(answer.contacts_complete || answer.contacts_late);
      EXPECT_EQ(answer.verdict, Verdict::hit);
    }
    EXPECT_GE(flush, 38) << microseconds;
    const Answer& last = pair.run(pose, short_request(clock, microseconds));
    const std::vector<Contact> found(last.contacts.begin(), last.contacts.end());
    Pair careful = std::move(Pair::make(brick, brick)).value();
    Request all;
    all.max_contacts = 4;
    const Answer& exact = careful.run(pose, all);
    ASSERT_TRUE(exact.contacts_complete);
    ASSERT_EQ(found.size(), exact.contacts.size());
    for (const Contact& contact : exact.contacts) {
      const bool is_there = std::any_of(found.begin(), found.end(), [&](const Contact& other) {
        return (other.position - contact.position).norm() < 1e-3 && std::abs(other.depth - contact.depth) < 1e-9 &&
               other.normal.dot(contact.normal) > 0.999999;
      });
      EXPECT_TRUE(is_there) << contact.position.transpose();
    }
  }
}

// A patch of all there is says whether anything else touches; then flat faces say where, whatever the budget.
TEST(FlushPair, TakeThePlaceOfAWholePatch) {
  const auto brick = shape_of(slab(10));
  realtime::ManualClock clock(1);
  Request in_time = short_request(clock, 200.0);
  in_time.carry_motion = 1e-5;
  Request in_work = in_time;
  in_work.budget = Budget::work(4000);
  Request unlimited = in_time;
  unlimited.budget = {};
  for (const Request& request : {in_time, in_work, unlimited}) {
    Pair pair = late_pair(brick, brick);
    for (int run = 0; run < 20; ++run) {
      math::Pose pose = below(1e-3, 0.3);
      pose.translation.x() = 0.2 + 0.001 * run;
      const Answer& answer = pair.run(pose, request);
      EXPECT_TRUE(answer.contacts_flush && answer.contacts_complete) << run;
      EXPECT_FALSE(answer.contacts_late);
      ASSERT_EQ(answer.contacts.size(), 4U);
      for (const Contact& contact : answer.contacts) {
        EXPECT_NEAR(contact.depth, 1e-3, 1e-12) << "all of it, at once: it was measured";
        EXPECT_GT(contact.normal.z(), 0.999999);
      }
      const std::vector<Contact> made(answer.contacts.begin(), answer.contacts.end());
      pose.translation.z() -= 1e-7;
      const Answer& later = pair.run(pose, request);
      EXPECT_TRUE(later.contacts_carried) << "of a body at rest they stay where they are";
      ASSERT_EQ(later.contacts.size(), 4U);
      for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((later.contacts[i].position - made[i].position).norm(), 2e-7);
    }
    Request springs = request;
    springs.late_contacts = false;
    EXPECT_FALSE(pair.run(below(1e-3, 0.1), springs).contacts_flush) << "what each run has seen itself";
  }
}

TEST(FlushPair, OfAPatchThatSaysMoreAreNotAll) {
  // Also of a part of the rim: of so many cells more pairs of triangles meet than are kept.
  for (const int cells : {6, 90}) {
    const auto ground = shape_of(made_mesh("made:box:x=4,y=4,z=0.2,cells=" + std::to_string(2 + cells / 2)));
    const Vec3 place(-0.7, -0.7, 0.0);
    const auto both =
        shape_of(testing::joined(made_mesh("made:box:x=1,y=1,z=0.2,cells=" + std::to_string(cells)),
                                 made_mesh("made:icosphere:frequency=12,radius=0.1"), place + Vec3(0, 0, -0.001)));
    Pair pair = late_pair(both, ground);
    Pair plain = std::move(Pair::make(both, ground)).value();
    Request request;
    request.max_contacts = 8;
    int of_ball = 0;
    int of_ball_without = 0;
    const auto has_ball = [&](const Answer& answer) {
      return std::any_of(answer.contacts.begin(), answer.contacts.end(),
                         [&](const Contact& contact) { return (contact.position - place).head<2>().norm() < 0.1; });
    };
    for (int run = 0; run < 40; ++run) {
      of_ball += has_ball(pair.run(below(1e-4, 0.01 * run), request)) ? 1 : 0;
      of_ball_without += has_ball(plain.run(below(1e-4, 0.01 * run), request)) ? 1 : 0;
    }
    EXPECT_EQ(of_ball, of_ball_without) << cells;
    EXPECT_GT(of_ball, 25) << cells;
  }
}

// What is called complete has all feet, wherever the time runs out.
TEST(FlushPair, AreCompleteWithAllFeetOnly) {
  mesh::TriangleMesh table = made_mesh("made:box:x=1,y=1,z=0.1,cells=2");
  for (const double x : {-0.45, 0.45}) {
    for (const double y : {-0.45, 0.45}) {
      table = testing::joined(table, made_mesh("made:box:x=0.1,y=0.1,z=0.1,cells=2"), Vec3(x, y, -0.08));
    }
  }
  const auto floor = shape_of(made_mesh("made:box:x=4,y=4,z=0.2,cells=4"));
  Pair pair = late_pair(shape_of(std::move(table)), floor);
  Request request;
  request.max_contacts = 8;
  request.carry_motion = 1e-5;
  request.method = Method::exact;
  const auto at = [](int run) {
    math::Pose pose;
    pose.translation = {1e-3 * (run % 50), 0.0, -0.23 + 1e-4};
    return pose;
  };
  realtime::ManualClock clock(200);
  for (int run = 0; run < 1500; ++run) {  // patches that do not end teach the reserve
    request.late_contacts = false;
    request.budget = Budget::time(50.0 + 0.5 * (run % 300));
    request.budget.clock = clock.clock();
    static_cast<void>(pair.run(at(run), request));
  }
  request.late_contacts = true;
  int complete = 0;
  for (int run = 0; run < 3000; ++run) {
    pair.reset();
    request.budget = {};
    static_cast<void>(pair.run(at(-2), request));
    request.budget = Budget::time(50.0 + 0.1 * run);
    request.budget.clock = clock.clock();
    const Answer& answer = pair.run(at(run), request);
    if (!answer.contacts_flush || !answer.contacts_complete) continue;
    ++complete;
    bool feet[2][2] = {};
    for (const Contact& contact : answer.contacts) feet[contact.position.x() > 0.0][contact.position.y() > 0.0] = true;
    EXPECT_TRUE(feet[0][0] && feet[0][1] && feet[1][0] && feet[1][1]) << run;
  }
  EXPECT_GT(complete, 300);
}

// A crate on the floor at a wall, both of one mesh: while the wall's contacts are guessed or late, the floor's hold.
TEST(FlushPair, HoldBesideWhatElseTouches) {
  const auto room = shape_of(testing::joined(made_mesh("made:box:x=2,y=1,z=0.2,cells=4"),
                                             made_mesh("made:box:x=0.1,y=1,z=0.6,cells=4"), Vec3(0.6, 0, 0.25)));
  const auto crate = shape_of(made_mesh("made:box:x=0.2,y=0.2,z=0.2,cells=4"));
  realtime::ManualClock clock(100);
  Pair pair = late_pair(room, crate);
  Request request = short_request(clock, 20.0);
  request.max_contacts = 8;
  int floor = 0;
  constexpr int runs = 400;
  for (int run = 0; run < runs; ++run) {
    // It comes to the wall with an edge ahead, and turns there.
    const double yaw = 0.3 + 1e-3 * run;
    const double reach = 0.1 * (std::cos(yaw) + std::sin(yaw));
    math::Pose pose;
    pose.rotation = Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix();
    pose.translation = {std::min(0.45 + 1e-3 * run, 0.55 - reach + 1e-4), 0.1, 0.2 - 1e-5};
    const Answer& answer = pair.run(pose, request);
    const auto bears = [](const Contact& contact) { return contact.normal.z() < -0.99 && contact.depth > 0.0; };
    floor += std::count_if(answer.contacts.begin(), answer.contacts.end(), bears) >= 3 ? 1 : 0;
  }
  EXPECT_GT(floor, runs - 20);
}

// It slides on its floor by 2 mm a run: a budget of 5 us has time for the floor, and would hear of the wall from the
// work on a patch, many runs later.
TEST(FlushPair, AWallIsFeltAsSoonAsItIsReached) {
  const auto room = shape_of(testing::joined(made_mesh("made:box:x=2,y=1,z=0.2,cells=4"),
                                             made_mesh("made:box:x=0.1,y=1,z=0.6,cells=4"), Vec3(0.6, 0, 0.25)));
  const auto crate = shape_of(made_mesh("made:box:x=0.2,y=0.2,z=0.2,cells=4"));
  constexpr double step = 2e-3;
  math::Random random(7);
  int late = 0;
  for (int k = 0; k < 20; ++k) {
    realtime::ManualClock clock(100);
    Pair pair = late_pair(room, crate);
    Request request = short_request(clock, 5.0);
    request.max_contacts = 8;
    math::Pose pose;
    const double yaw = random.uniform(0.05, 1.5);
    pose.rotation = Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix();
    const double reach = 0.1 * (std::cos(yaw) + std::sin(yaw));
    const double start = random.uniform(0.0, 0.1);
    int run = 0;
    for (bool felt = false; !felt; ++run) {
      const double x = start + step * run;
      pose.translation = {x, random.uniform(-1e-4, 1e-4), 0.2 - 1e-5};
      const Answer& answer = pair.run(pose, request);
      const auto holds = [](const Contact& contact) { return contact.normal.x() > 0.9; };  // into the room
      felt = std::any_of(answer.contacts.begin(), answer.contacts.end(), holds);
      const double in_wall = x + reach - 0.55;
      EXPECT_TRUE(!felt || in_wall > -1e-6) << "there is no wall yet, yaw " << yaw;
      if (in_wall > 2.0 * step) {
        ++late;
        break;
      }
    }
  }
  EXPECT_LE(late, 2) << "of 20";
}

TEST(FlushPair, OfARunWithoutAProofAreGivenAllTheSame) {
  const auto brick = shape_of(slab(10));
  realtime::ManualClock clock(50);
  Pair pair = late_pair(brick, brick);
  const math::Pose pose = below(1e-5, 0.3);
  for (int run = 0; run < 20; ++run) static_cast<void>(pair.run(pose, short_request(clock, 5.0)));
  realtime::ManualClock slow(500);  // the time is up after a few looks
  int unproved = 0;
  for (int run = 0; run < 20; ++run) {
    // Far enough for no pair of triangles that met to meet still.
    const Answer& answer = pair.run(below(1e-5, 0.3 + 0.02 * run), short_request(slow, 3.0));
    if (answer.basis == Basis::proved) continue;
    ++unproved;
    EXPECT_EQ(answer.verdict, Verdict::hit);
    EXPECT_GE(answer.probability, tolerances::flush_probability);
    EXPECT_TRUE(answer.contacts_flush);
    EXPECT_EQ(answer.contacts.size(), 4U);
  }
  EXPECT_GT(unproved, 0);
}

// What is claimed with 0.99 is true in 99 of 100 cases at least: of slabs just within or above each other.
TEST(FlushPair, AClaimWithoutAProofIsTrue) {
  const auto a = shape_of(slab(6));
  const auto b = shape_of(slab(9));
  Pair careful = std::move(Pair::make(a, b)).value();
  Pair pair = late_pair(a, b);
  int claims = 0;
  int wrong = 0;
  for (int i = 0; i < 1600; ++i) {
    math::Random random(static_cast<std::uint64_t>(i));
    const double turn = random.uniform(-3, 3);
    math::Pose pose = below(1e-5, turn);
    pose.translation.x() = random.uniform(-0.9, 0.9);
    pair.reset();
    realtime::ManualClock clock(50);
    for (int run = 0; run < 3; ++run) static_cast<void>(pair.run(pose, short_request(clock)));
    const math::Pose moved = below(random.uniform(-2e-6, 2e-6), turn + 0.3, random.uniform(-1e-6, 1e-6));
    pose.rotation = moved.rotation;
    pose.translation.z() = moved.translation.z();
    realtime::ManualClock slow(500);
    const Answer& answer = pair.run(pose, short_request(slow, 3.0));
    if (answer.basis == Basis::proved || !answer.contacts_flush) continue;
    ++claims;
    wrong += careful.run(pose, {}).verdict == Verdict::hit ? 0 : 1;
  }
  EXPECT_GT(claims, 100);
  EXPECT_LE(100 * wrong, claims);
}

// Whose round ends are polygons of a few corners for flush contacts, and cross outside of them.
TEST(FlushPair, CansStandOnEachOther) {
  const auto can = shape_of(made_mesh("made:peg:radius=0.3,length=0.4,chamfer=0.01,around=64"));
  realtime::ManualClock clock(50);
  Pair pair = late_pair(can, can);
  int flush = 0;
  for (int run = 0; run < 200; ++run) {
    math::Pose pose;
    pose.rotation = Eigen::AngleAxisd(0.3 + 1e-3 * run, Vec3::UnitZ()).toRotationMatrix();
    pose.translation = {1e-4 * run, 0.0, -0.4 + 1e-5};
    const Answer& answer = pair.run(pose, short_request(clock));
    if (!answer.contacts_flush) continue;
    ++flush;
    EXPECT_GE(answer.contacts.size(), 4U);
    for (const Contact& contact : answer.contacts) EXPECT_GT(contact.normal.z(), 0.999);
  }
  EXPECT_GT(flush, 190);
}

TEST(FlushPair, OfABodyThatAlsoTouchesElsewhereAreNotAll) {
  const auto ground = shape_of(made_mesh("made:box:x=4,y=4,z=0.2,cells=4"));
  // Beside a wide foot, and beside a narrow one, nearer to it than it is long.
  for (const auto& [name, place] : {std::pair{"made:box:x=1,y=1,z=0.2,cells=6", Vec3(1.0, 0.0, 0.0)},
                                    {"made:box:x=1,y=0.1,z=0.2,cells=6", Vec3(0.0, 0.35, 0.0)}}) {
    const auto both = shape_of(testing::joined(made_mesh(name), made_mesh("made:icosphere:frequency=12,radius=0.1"),
                                               place + Vec3(0.0, 0.0, -0.001)));
    ASSERT_TRUE(both->is_solid());
    realtime::ManualClock clock(50);
    Pair pair = late_pair(both, ground);
    const math::Pose pose = below(1e-4);
    int of_ball = 0;
    int flush = 0;
    for (int run = 0; run < 3000; ++run) {
      const Answer& answer = pair.run(pose, short_request(clock, 10.0));
      if (run < 2000) continue;
      flush += answer.contacts_flush ? 1 : 0;
      const auto is_of_ball = [&place = place](const Contact& contact) {
        return (contact.position - place).head<2>().norm() < 0.1;
      };
      of_ball += std::any_of(answer.contacts.begin(), answer.contacts.end(), is_of_ball) ? 1 : 0;
    }
    EXPECT_EQ(flush, 0) << name;
    EXPECT_GT(of_ball, 900) << name;
  }
}

// Of thin sheets the far sides face each other, too: whichever body is first, they are pushed apart, not together.
TEST(FlushPair, ThinSheetsArePushedApart) {
  const auto sheet = shape_of(made_mesh("made:box:x=1,y=1,z=0.003,cells=5"));
  const auto board = shape_of(made_mesh("made:box:x=1.6,y=1,z=0.02,cells=7"));
  for (const bool board_first : {false, true}) {
    realtime::ManualClock clock(50);
    Pair pair = board_first ? late_pair(board, sheet) : late_pair(sheet, board);
    math::Pose sheet_on_board;
    sheet_on_board.translation.z() = 0.0115 - 1e-5;
    const math::Pose pose = board_first ? sheet_on_board : sheet_on_board.inverse();
    int flush = 0;
    for (int run = 0; run < 100; ++run) {
      const Answer& answer = pair.run(pose, short_request(clock, 5.0));
      flush += answer.contacts_flush ? 1 : 0;
      for (const Contact& contact : answer.contacts) {
        EXPECT_GT(board_first ? -contact.normal.z() : contact.normal.z(), 0.9) << run;
      }
    }
    EXPECT_GT(flush, 90);
  }
}

TEST(FlushPair, AreOfSolidsAlone) {
  // Without its lid a box has two-sided walls.
  mesh::TriangleMesh closed = slab(3);
  std::vector<Vec3> vertices(closed.vertices().begin(), closed.vertices().end());
  std::vector<mesh::Triangle> triangles(closed.triangles().begin(), closed.triangles().end() - 1);
  const auto open =
      shape_of(std::move(mesh::TriangleMesh::make(std::move(vertices), std::move(triangles), "open")).value());
  realtime::ManualClock clock(50);
  Pair pair = late_pair(open, shape_of(slab(3)));
  for (int run = 0; run < 40; ++run) {
    EXPECT_FALSE(pair.run(below(1e-4), short_request(clock, 5.0)).contacts_flush);
  }
}

TEST(FlushPair, TakeNoMemoryInARun) {
  const auto brick = shape_of(slab(10));
  realtime::ManualClock clock(50);
  Pair pair = late_pair(brick, brick);
  const support::AllocationCounter counter;
  for (int run = 0; run < 50; ++run) static_cast<void>(pair.run(below(1e-5, 0.01 * run), short_request(clock, 5.0)));
  EXPECT_EQ(counter.allocations(), 0U);
}

}  // namespace
}  // namespace odds::query
