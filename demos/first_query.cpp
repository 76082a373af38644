// One query, three ways: without a limit, within 3 microseconds, and within a repeatable amount of work.
#include <odds/mesh/made/by_name.hpp>
#include <odds/query/pair.hpp>

#include <cstdio>
#include <cstdlib>

namespace {

template <class T>
T value_or_exit(odds::Result<T> result) {
  if (result) return std::move(result).value();
  std::fprintf(stderr, "error: %s\n", result.error().message().c_str());
  std::exit(1);
}

void print(const char* title, const odds::query::Answer& answer) {
  constexpr const char* verdicts[] = {"clear", "hit"};
  constexpr const char* bases[] = {"proved", "estimated", "budget"};
  std::printf("%-16s %-5s (%s), P = %.3f, %zu contacts, %llu node pairs, %.1f us\n", title,
              verdicts[static_cast<int>(answer.verdict)], bases[static_cast<int>(answer.basis)], answer.probability,
              answer.contacts.size(), static_cast<unsigned long long>(answer.cost.node_pairs), answer.cost.gross_us);
}

}  // namespace

int main() {
  using namespace odds;

  // Load or make a mesh, build its hierarchy once; shapes are immutable and can be shared by any number of pairs.
  auto mesh = std::make_shared<const mesh::TriangleMesh>(value_or_exit(mesh::made::make_shape("made:torus_knot")));
  auto shape = value_or_exit(query::Shape::build(mesh));

  // A pair holds all memory that queries need: nothing is allocated after this line.
  query::Pair pair = value_or_exit(query::Pair::make(shape, shape));

  // Where B stands in A's frame, metres.
  math::Pose pose_b_in_a;
  pose_b_in_a.translation = {0.0, 0.0, 0.05};  // a near miss: the hardest case

  query::Request request;  // its defaults ask for a proof and for one contact
  print("no limit", pair.run(pose_b_in_a, request));

  request.budget = query::Budget::time(3.0);
  print("3 microseconds", pair.run(pose_b_in_a, request));

  request.budget = query::Budget::work(100);
  print("100 work units", pair.run(pose_b_in_a, request));
}
