// Queries after the run.
#include "tool/replay_marks.hpp"

namespace odds::tool {
namespace {

constexpr std::size_t most_queries = 50'000;
constexpr std::size_t most_marks = 64;

query::Request request_of(const scene::Simulation& simulation) {
  query::Request request = simulation.scene().query;
  request.budget = scene::in_work_units(simulation.budget());
  return request;
}

}  // namespace

ReplayMarks::ReplayMarks(const scene::Simulation& simulation)
    : simulation_(simulation), request_(request_of(simulation)) {
  for (const scene::Body& body : simulation.scene().bodies) {
    const mesh::TriangleMesh& mesh = simulation.shapes()[body.mesh]->mesh();
    balls_.push_back({0.5 * (mesh.lower() + mesh.upper()), 0.5 * mesh.size()});
  }
  pairs_.resize(balls_.size() * balls_.size());
}

void ReplayMarks::add(const std::vector<math::Pose>& poses, report::ReplayFrame& frame) {
  const std::vector<scene::Body>& bodies = simulation_.scene().bodies;
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      if (queries_ >= most_queries || frame.marks.size() >= most_marks) return;
      if (!bodies[a].dynamic && !bodies[b].dynamic) continue;
      const double apart = (poses[a] * balls_[a].center - poses[b] * balls_[b].center).norm();
      if (apart <= balls_[a].radius + balls_[b].radius) ask(a, b, poses, frame);
    }
  }
}

void ReplayMarks::ask(std::size_t a, std::size_t b, const std::vector<math::Pose>& poses, report::ReplayFrame& frame) {
  const std::vector<scene::Body>& bodies = simulation_.scene().bodies;
  std::unique_ptr<query::Pair>& pair = pairs_[a * balls_.size() + b];
  if (pair == nullptr) {
    auto made = query::Pair::make(simulation_.shapes()[bodies[a].mesh], simulation_.shapes()[bodies[b].mesh]);
    if (!made) return;  // the run itself could not do without it
    pair = std::make_unique<query::Pair>(std::move(made).value());
  }
  ++queries_;
  const query::Answer& answer = pair->run(poses[a].inverse() * poses[b], request_);
  const auto mark = [&](const query::Contact& contact, double probability, bool cell_pair) {
    frame.marks.push_back(
        {poses[a] * contact.position, poses[a].rotation * contact.normal, contact.depth, probability, cell_pair});
  };
  for (const query::Contact& contact : answer.contacts) mark(contact, 1.0, false);
  if (answer.contacts.empty() && answer.has_cell_pair && answer.basis != query::Basis::proved) {
    mark(answer.cell_pair, answer.cell_pair_probability, true);
  }
}

}  // namespace odds::tool
