// The list of hard cases.
#include <fmt/core.h>

#include "hard_cases/hard_case.hpp"
#include "hard_cases/meshes.hpp"

namespace odds::hard_cases {
namespace {

std::string mesh(const std::string& name, const std::string& file) {
  return "[[mesh]]\nname = \"" + name + "\"\nfile = \"" + file + "\"\n";
}
std::string fixed(const std::string& name, const std::string& of, const std::string& at = "[0, 0, 0]") {
  return "[[body]]\nname = \"" + name + "\"\nmesh = \"" + of + "\"\nposition_m = " + at + "\n";
}
std::string moving(const std::string& name, const std::string& of, const std::string& mass, const std::string& at) {
  return "[[body]]\nname = \"" + name + "\"\nmesh = \"" + of + "\"\nmotion = \"dynamic\"\nmass_kg = " + mass +
         "\nposition_m = " + at + "\n";
}
std::string tool(const std::string& of, const std::string& mass = "0.05") {
  return "[[body]]\nname = \"tool\"\nmesh = \"" + of + "\"\nmotion = \"dynamic\"\nmass_kg = " + mass +
         "\ndevice = \"hand\"\n";
}
// Goes by `down`, waits, then by `along`.
std::string hand(const std::string& at, const std::string& down, const std::string& along,
                 const std::string& more = "type = \"scripted\"\n") {
  return "[device.hand]\n" + more + "position_m = " + at +
         "\n[[device.hand.motion]]\nkind = \"slide\"\nduration_s = 0.4\nby_m = " + down +
         "\n[[device.hand.motion]]\nkind = \"hold\"\nduration_s = 0.1\n[[device.hand.motion]]\nkind = "
         "\"slide\"\nduration_s = 0.5\nby_m = " +
         along + "\n";
}

const std::string slab = mesh("slab", "made:box:x=0.2,y=0.2,z=0.04,cells=8");  // its top at z = 0.02
const std::string contact = "[effects.contact]\n";
// These knots are round tubes, which spheres fill well: these take over as soon as they meet.
const std::string deep = "[effects.deep_contact]\nfrom = 0.001\nfull = 0.01\n";
const std::string friction = "[effects.friction]\nmu = 0.3\n";
const std::string pull = "[effects.virtual_coupling]\nk_t_n_per_m = 500\nb_t_ns_per_m = 2\n";
const std::string gravity = "[effects.gravity]\n";

std::vector<HardCase> shapes() {
  return {
      {"knife_edge", "An edge of 2 degrees is pressed on a plate and drawn across it.",
       slab + mesh("knife", "wedge.obj") + fixed("plate", "slab") + tool("knife") +
           hand("[0, 0, 0.022]", "[0, 0, -0.006]", "[0.03, 0.03, 0]") + contact + friction + pull},
      {"point", "A needle is pressed on a plate and drawn across it.",
       slab + mesh("needle", "spike.obj") + fixed("plate", "slab") + tool("needle") +
           hand("[0, 0, 0.022]", "[0, 0, -0.006]", "[0.03, 0.02, 0]") + contact + friction + pull},
      {"coplanar", "A block lies with its face exactly in the plane of another's, edges flush, and is pushed along it.",
       mesh("block", "made:box:x=0.04,y=0.04,z=0.04,cells=4") + fixed("plate", "block") + tool("block") +
           hand("[0, 0, 0.04]", "[0, 0, -0.002]", "[0.01, 0, 0]") + contact + friction + pull},
      {"slivers", "A ball on a plate of slivers, a millionth as wide as long.",
       mesh("plate", "slivers.obj") + mesh("ball", "made:icosphere:radius=0.01") + fixed("plate", "plate") +
           tool("ball") + hand("[0, 0.003, 0.012]", "[0, 0, -0.006]", "[0.01, 0.03, 0]") + contact + friction + pull},
      {"thin_sheet_fast", "A ball flies at 5 m/s at a sheet without thickness; the scene asks for sub-steps.",
       mesh("sheet", "sheet.obj") + mesh("ball", "made:icosphere:radius=0.005") + fixed("sheet", "sheet") +
           tool("ball") +
           "[device.hand]\ntype = \"scripted\"\nposition_m = [0, 0, 0.15]\n[[device.hand.motion]]\nkind = "
           "\"slide\"\nduration_s = 0.06\n"
           "by_m = [0, 0, -0.155]\n" +
           "[physics]\nsubstep_way_m = 0.001\nmost_substeps = 16\n" +
           "[effects.contact]\nstiffness_n_per_m = 50000\ndamping_ns_per_m = 50\n" + pull,
       0.5, Trouble::none, 5.0, 1e-3, 5e-4, 0.05, false, "tool", 0.0},
  };
}

// Contacts may give no more than this and what they have taken, and what the step gives in which it runs dry.
const std::string tank = "[effects.energy_tank]\ninitial_j = 1e-4\n";

std::vector<HardCase> overlaps(const std::string& knot) {
  const std::string inside = slab + mesh("ball", "made:icosphere:radius=0.01") + fixed("plate", "slab") + tool("ball") +
                             hand("[0, 0, 0.015]", "[0, 0, 0.02]", "[0.01, 0, 0]") + contact + pull;
  const std::string teeth =
      mesh("gear", "made:gear") + fixed("gear", "gear") + tool("gear", "0.1") +
      "[device.hand]\ntype = \"scripted\"\nposition_m = [0.055, 0, 0.001]\n[[device.hand.motion]]\nkind = "
      "\"slide\"\n"
      "duration_s = 0.3\nby_m = [-0.006, 0, 0]\n[[device.hand.motion]]\nkind = \"hold\"\nduration_s = "
      "0.7\nturn_rad = 1.5\n" +
      contact + friction + pull;
  return {
      {"starts_inside", "The tool starts 15 mm inside a block.", inside, 1.0, Trouble::none, 5.0, 0.05, 5e-4, 0.05,
       false},
      {"starts_inside_tank", "The same with an energy tank of 0.1 mJ: the overlap must not become motion.",
       inside + tank, 1.0, Trouble::none, 5.0, 1e-3, 5e-4, 0.05, false},
      {"full_overlap",
       "Two equal knots lie exactly in each other; the hand draws one out. The scene asks for deep_contact.",
       mesh("knot", knot) + fixed("knot", "knot") + tool("knot") + hand("[0, 0, 0]", "[0, 0, 0.4]", "[0.3, 0, 0.4]") +
           contact + deep + pull,
       1.2, Trouble::none, 5.0, 0.2, 5e-4, 0.05, false},  // 0.8 J: 40 N at most, over 20 mm
      {"alternating_sets", "A gear is pushed into another's teeth and turned: contacts come and go.", teeth, 1.0,
       Trouble::none, 5.0, 5e-3, 1e-3, 0.05, false},
      {"alternating_tank", "The same with an energy tank of 0.1 mJ.", teeth + tank, 1.0, Trouble::none, 5.0, 2e-4, 1e-3,
       0.05, false},
  };
}

std::vector<HardCase> scales() {
  return {
      {"far_away", "Everything stands 1000 km from the origin.",
       slab + mesh("ball", "made:icosphere:radius=0.01") + fixed("plate", "slab", "[1e6, 0, 0]") + tool("ball") +
           hand("[1e6, 0, 0.032]", "[0, 0, -0.006]", "[0.03, 0.01, 0]") + contact + friction + pull},
      {"far_vertices", "The vertices of the plate stand 1000 km from its mesh's origin.",
       mesh("slab", "far_slab.obj") + mesh("ball", "made:icosphere:radius=0.01") +
           fixed("plate", "slab", "[-1e6, 0, 0]") + tool("ball") +
           hand("[0, 0, 0.032]", "[0, 0, -0.006]", "[0.03, 0.01, 0]") + contact + friction + pull},
      {"micrometres", "A cube of 50 micrometres and 1e-6 kg on a plate of the same make.",
       mesh("cube", "micro.obj") + fixed("plate", "cube") + tool("cube", "1e-6") +
           hand("[0, 0, 52e-6]", "[0, 0, -6e-6]", "[1e-5, 0, 0]") +
           "[effects.contact]\nstiffness_n_per_m = 200\ndamping_ns_per_m = 0.01\n" +
           "[effects.virtual_coupling]\nk_t_n_per_m = 10\nb_t_ns_per_m = 0.02\nk_r_nm_per_rad = 1e-7\nb_r_nms_per_rad "
           "= 1e-9\n",
       1.0, Trouble::none, 5.0, 1e-9, 5e-6, 1e-6, true},
      {"mass_ratio", "500 kg lie on 50 g, which lie on the floor: 1 to 10,000.",
       slab + mesh("cube", "made:box:x=0.06,y=0.06,z=0.06,cells=2") + fixed("floor", "slab") +
           moving("light", "cube", "0.05", "[0, 0, 0.0498]") + moving("heavy", "cube", "500", "[0, 0, 0.1095]") +
           "[effects.contact]\nstiffness_n_per_m = 1e7\ndamping_ns_per_m = 20000\n" + friction + gravity,
       1.0, Trouble::none, 5.0, 1e-3, 5e-4, 0.05, false, "heavy", 0.105},
      {"thousand_contacts", "A lid on 272 posts: more points of contact than the thousand that the scene allows.",
       mesh("lid", "made:box:x=0.5,y=0.5,z=0.02,cells=12") + mesh("post", "made:box:x=0.02,y=0.02,z=0.02,cells=2") +
           [] {
             std::string posts;
             for (int i = 0; i < 272; ++i) {
               posts += fixed(fmt::format("post{}", i), "post",
                              fmt::format("[{}, {}, 0]", 0.03 * (i % 16) - 0.225, 0.03 * (i / 16) - 0.24));
             }
             return posts;
           }() +
           moving("lid", "lid", "2", "[0, 0, 0.0199]") +
           "[physics]\nsolver = \"iterative\"\nmax_contacts = 1024\n[effects.contact]\ndamping_ns_per_m = 100\n" +
           gravity,
       0.1, Trouble::none, 5.0, 1e-3, 5e-4, 0.05, false, "lid", 0.015},
  };
}

std::vector<HardCase> control(const std::string& knot) {
  const std::string pressed = slab + mesh("ball", "made:icosphere:radius=0.01") + fixed("plate", "slab") + tool("ball");
  const std::string light =
      slab + mesh("ball", "made:icosphere:radius=0.01") + fixed("plate", "slab") + tool("ball", "0.001");
  const std::string press = hand("[0, 0, 0.032]", "[0, 0, -0.008]", "[0.03, 0.01, 0]");
  const std::string arm =
      "type = \"human_arm\"\nphysical_damping_ns_per_m = 0.4\narm_damping_ns_per_m = 0.1\narm_stiffness_n_per_m = 300\n"
      "device_mass_kg = 0.05\narm_mass_kg = 0.05\n";
  return {
      {"too_stiff", "A hand that gives way presses on 4000 N/m with a quarter of the damping that the rule asks for.",
       light + hand("[0, 0, 0.032]", "[0, 0, -0.012]", "[0.03, 0.01, 0]", arm) +
           "[effects.contact]\nstiffness_n_per_m = 1e6\ndamping_ns_per_m = 0\nmax_correcting_velocity_m_per_s = "
           "10\n[effects.virtual_coupling]\nk_t_n_per_m = 4000\nb_t_ns_per_m = "
           "0\n",
       1.5, Trouble::none, 5.0, 0.5, 5e-4, 0.05, false},
      {"too_stiff_controlled", "The same with the passivity controller.",
       light + hand("[0, 0, 0.032]", "[0, 0, -0.012]", "[0.03, 0.01, 0]", arm) +
           "[effects.contact]\nstiffness_n_per_m = 1e6\ndamping_ns_per_m = 0\nmax_correcting_velocity_m_per_s = "
           "10\n[effects.virtual_coupling]\nk_t_n_per_m = 4000\nb_t_ns_per_m = "
           "0\n"
           "[effects.passivity_control]\nmax_damping_ns_per_m = 20\n",
       1.5, Trouble::none, 5.0, 2e-3, 5e-4, 0.05, false},
      {"penalty_law", "The same press by a penalty force of 10,000 N/m, near the edge of its stability.",
       pressed + press + "[effects.contact]\nlaw = \"penalty\"\nstiffness_n_per_m = 10000\n" + friction + pull},
      {"penalty_too_stiff", "And of 100,000 N/m, eight times what the warning calls safe.",
       pressed + press + "[effects.contact]\nlaw = \"penalty\"\nstiffness_n_per_m = 1e5\n" + friction + pull, 1.0,
       Trouble::none, 5.0, 2e-3, 5e-4, 0.05, false},
      {"constraint_law", "The same press against a constraint: no overlap at all.",
       pressed + press + "[effects.contact]\nlaw = \"constraint\"\n" + friction + pull},
      {"missed_ticks", "One tick in ten never runs, now and then forty in a row.",
       pressed + press + contact + friction + pull, 1.0, Trouble::missed_ticks, 5.0, 1e-3, 5e-4, 0.05, false},
      {"clock_jumps", "The clock jumps ahead by 300 ms, twice, and stands still, once.",
       pressed + press + contact + friction + pull, 1.5, Trouble::clock_jumps, 5.0, 5e-3, 5e-4, 0.05, false},
      {"device_drops_out", "The device says nothing for 100 ms in contact, and refuses a command later.",
       pressed +
           hand("[0, 0, 0.032]", "[0, 0, -0.008]", "[0.03, 0.01, 0]", "type = \"troubled\"\ntrouble = \"silent\"\n") +
           contact + friction + pull,
       1.0, Trouble::none, 5.0, 2e-3, 5e-4, 0.05, true},
      {"device_says_nan", "Every seventh state of the device is not a number, or infinite.",
       pressed +
           hand("[0, 0, 0.032]", "[0, 0, -0.008]", "[0.03, 0.01, 0]", "type = \"troubled\"\ntrouble = \"nan\"\n") +
           contact + friction + pull},
      {"meshes_at_speed", "Two knots brush past each other at 1.5 m/s. The scene asks for deep_contact.",
       mesh("knot", knot) + fixed("knot", "knot") + tool("knot", "0.2") +
           "[device.hand]\ntype = \"scripted\"\nposition_m = [0.02, 0.25, 0.03]\n[[device.hand.motion]]\nkind = "
           "\"slide\"\n"
           "duration_s = 0.6\nby_m = [0.01, -0.5, 0]\nturn_rad = 1.0\n" +
           contact + deep + friction + pull,
       0.8, Trouble::none, 5.0, 5e-3, 2e-3, 0.05, false},
  };
}

}  // namespace

std::vector<HardCase> all_cases(const std::string& folder, const std::string& knot) {
  write_meshes(folder);
  std::vector<HardCase> all;
  for (auto part : {shapes(), overlaps(knot), scales(), control(knot)}) {
    for (HardCase& one : part) all.push_back(std::move(one));
  }
  return all;
}

}  // namespace odds::hard_cases
