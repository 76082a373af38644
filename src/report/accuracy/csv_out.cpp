// A study's tables as text. Doubles are the shortest decimals that read back to the same bits.
#include <fmt/format.h>

#include <iterator>

#include "report/accuracy/study_files.hpp"

namespace odds::report {
namespace {

constexpr const char* poses_heading = "pose,band,offset,x,y,z,qw,qx,qy,qz,hit,contacts,px,py,pz,nx,ny,nz,depth\n";

std::string pose_line(const Study& study, const PoseTruth& truth) {
  const MadePose& p = truth.pose;
  std::string line =
      fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", p.index, pose_bands(study.settings.procedure)[p.band].name,
                  p.offset, p.translation.x(), p.translation.y(), p.translation.z(), p.rotation.w(), p.rotation.x(),
                  p.rotation.y(), p.rotation.z(), truth.hit ? 1 : 0, truth.contacts);
  if (truth.contacts == 0) return line + ",,,,,,,\n";
  const query::Contact& c = truth.deepest_contact;
  return line + fmt::format(",{},{},{},{},{},{},{}\n", c.position.x(), c.position.y(), c.position.z(), c.normal.x(),
                            c.normal.y(), c.normal.z(), c.depth);
}

}  // namespace

std::string poses_csv(const Study& study) {
  std::string text = poses_heading;
  for (const PoseTruth& truth : study.poses) text += pose_line(study, truth);
  return text;
}

std::string one_pose_csv(const Study& study, std::size_t pose) {
  return poses_heading + pose_line(study, study.poses[pose]);
}

std::string answers_csv(const Study& study) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "pose,limit,amount,p_min,verdict,basis,probability,node_pairs,triangle_pairs,wall_us,stall_us,"
                 "net_overshoot_us,position_error,normal_error_deg,depth_error,push_x,push_y,push_z\n");
  for (std::size_t t = 0; t < study.settings.trials.size(); ++t) {
    const Trial& trial = study.settings.trials[t];
    for (std::size_t i = 0; i < study.poses.size(); ++i) {
      const Sample& s = study.samples[t][i];
      fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},{},{}", study.poses[i].pose.index, name(trial.kind),
                     trial.amount, trial.p_min, name(s.verdict), name(s.basis), s.probability, s.node_pairs,
                     s.triangle_pairs, s.wall_us, s.stall_us, s.net_overshoot_us);
      if (s.contact) {
        fmt::format_to(out, ",{},{},{}", s.contact->position, s.contact->normal_deg, s.contact->depth);
      } else {
        fmt::format_to(out, ",,,");
      }
      fmt::format_to(out, ",{},{},{}\n", s.push.x(), s.push.y(), s.push.z());
    }
  }
  return fmt::to_string(text);
}

std::string rows_csv(const Study& study, const std::vector<AccuracyRow>& rows) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(
      out,
      "limit,amount,p_min,scope,band,poses,hits,proved,estimated,at_budget,share_proved,wrong,share_wrong,"
      "wrong_low,wrong_high,false_hits,false_hits_low,false_hits_high,false_misses,false_misses_low,"
      "false_misses_high,unproved,mean_probability,observed,observed_low,observed_high,calibration_error,brier,"
      "brier_reliability,brier_resolution,brier_uncertainty,brier_within_bins,brier_all,contacts,position_error_p50,"
      "position_error_p90,normal_error_deg_p50,normal_error_deg_p90,depth_error_p50,depth_error_p90,fallbacks,"
      "fallback_position_error_p50,fallback_position_error_p90,fallback_normal_error_deg_p50,"
      "fallback_normal_error_deg_p90,fallback_depth_error_p50,fallback_depth_error_p90,wall_us_p50,"
      "wall_us_p99,wall_us_p999,wall_us_max,net_overshoot_us_p50,net_overshoot_us_p99,net_overshoot_us_p999,"
      "net_overshoot_us_max\n");
  const auto write = [&](auto... values) { ((fmt::format_to(out, ",{}", values)), ...); };
  for (const AccuracyRow& r : rows) {
    const Trial& trial = study.settings.trials[r.trial];
    const ForecastQuality& q = r.unproved;
    const Interval wrong = r.wrong_interval();
    const Interval hits = r.false_hit_interval();
    const Interval misses = r.false_miss_interval();
    const Interval observed = wilson(q.happened, q.count);
    fmt::format_to(out, "{},{},{},{},{}", name(trial.kind), trial.amount, trial.p_min, r.scope, r.band);
    write(r.poses, r.hits, r.proved, r.estimated, r.at_budget, r.share_proved(), r.wrong(), r.share_wrong(), wrong.low,
          wrong.high, r.false_hits, hits.low, hits.high, r.false_misses, misses.low, misses.high);
    write(q.count, q.mean_probability, q.observed(), observed.low, observed.high, q.calibration_error, q.brier,
          q.reliability, q.resolution, q.uncertainty, q.within_bins, r.brier_all);
    write(r.contact.count, r.contact.p50.position, r.contact.p90.position, r.contact.p50.normal_deg,
          r.contact.p90.normal_deg, r.contact.p50.depth, r.contact.p90.depth);
    write(r.fallback.count, r.fallback.p50.position, r.fallback.p90.position, r.fallback.p50.normal_deg,
          r.fallback.p90.normal_deg, r.fallback.p50.depth, r.fallback.p90.depth);
    write(r.wall_us.p50, r.wall_us.p99, r.wall_us.p999, r.wall_us.max, r.net_overshoot_us.p50, r.net_overshoot_us.p99,
          r.net_overshoot_us.p999, r.net_overshoot_us.max);
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

}  // namespace odds::report
