#include "calibration/meetings.hpp"

#include <filesystem>
#include <utility>

namespace odds::calibration {
namespace {

using report::Procedure;

/// Of Debian's openfoam-examples.
std::string example(const std::string& file) {
  return "/usr/share/doc/openfoam-examples/examples/resources/geometry/" + file;
}
/// A surface of one of its cases.
std::string of_case(const std::string& directory, const std::string& file) {
  return "/usr/share/doc/openfoam-examples/examples/" + directory + "/constant/triSurface/" + file;
}
/// Of Debian's cura.
std::string of_printer(const std::string& file) { return "/usr/share/cura/resources/meshes/" + file; }
/// Of Debian's prusa-slicer.
std::string of_slicer(const std::string& file) { return "/usr/share/PrusaSlicer/" + file; }

Meeting with_its_copy(const std::string& mesh) { return {mesh, mesh}; }

std::vector<Meeting> present(std::vector<Meeting> meetings) {
  const auto is_there = [](const std::string& mesh) {
    return mesh.starts_with("made:") || std::filesystem::exists(mesh);
  };
  std::erase_if(meetings, [&](const Meeting& m) { return !is_there(m.a) || !is_there(m.b); });
  return meetings;
}

const std::string knot = "made:torus_knot:along=600,across=20";
const std::string bumpy = "made:bumpy_sphere:frequency=40";

std::vector<Meeting> of_made_shapes() {
  const std::string car = "made:car_body:triangles=60000";
  return {with_its_copy(car),
          with_its_copy(knot),
          with_its_copy(bumpy),
          {"made:gear:teeth=40,flank=8", "made:peg:radius=0.004,around=96"},
          {"made:gear:teeth=17,flank=20", "made:gear:teeth=61,flank=5"},
          {"made:terrain:cells=120,side=0.3,height=0.03", "made:icosphere:frequency=30"},
          {"made:uv_sphere:around=300,down=150", "made:box:cells=20"},
          {"made:plates:count=6,cells=60,wave=0.004", "made:peg:around=128,along=64"},
          {"made:bolt", "made:plate_with_hole"},
          with_its_copy("made:nut"),
          {"made:torus_knot:p=2,q=9,along=500,across=16", "made:terrain:cells=90,side=1,height=0.15,seed=5"},
          {"made:nested_shells:frequency=20,seed=3", "made:box:cells=30"},
          {"made:car_body:triangles=40000,seed=11", "made:bumpy_sphere:frequency=40,scale=8,seed=6"},
          with_its_copy("made:plates"),
          with_its_copy("made:torus_knot:p=3,q=2,along=400,across=12,tube=0.02"),
          with_its_copy("made:torus_knot:p=5,q=8,along=1200,across=14,tube=0.006"),
          {"made:car_body:triangles=100000,seed=21", "made:car_body:triangles=8000,seed=22,length=1.5"},
          with_its_copy("made:bumpy_sphere:frequency=25,bumps=6,width=0.9,height=0.4,seed=31"),
          {"made:bumpy_sphere:frequency=90,bumps=600,width=0.05,height=0.05,seed=33",
           "made:bumpy_sphere:frequency=24,bumps=20,seed=34"},
          with_its_copy("made:terrain:cells=150,side=1,height=0.3,seed=41"),
          {"made:terrain:cells=60,side=1,height=0.05,depth=0.2,seed=42", "made:torus_knot:along=256,across=16"},
          {"made:plates:count=12,cells=40,gap=0.01,wave=0.01", "made:torus:ring=0.05,tube=0.02,around=100,across=50"},
          with_its_copy("made:nested_shells:frequency=24,ratio=0.9,seed=6"),
          {"made:nested_shells:frequency=16,ratio=0.97,seed=8", "made:bumpy_sphere:frequency=30,seed=9"},
          with_its_copy("made:gear:teeth=12,flank=12,root=8,width=0.02"),
          {"made:gear:teeth=90,flank=6,module=0.001", "made:bolt:length=0.05,around=96,rows=2"},
          {"made:bolt:around=96,rows=3", "made:nut:around=96,rows=3"},
          {"made:peg:around=256,along=100", "made:peg:around=24,along=200,radius=0.005"},
          {"made:plate_with_hole:around=256,across=20,along=20", "made:plate_with_hole"},
          {"made:box:cells=40", "made:box:cells=3,x=0.3,y=0.02"},
          {"made:icosphere:frequency=60", "made:uv_sphere:around=60,down=200,radius=0.02"},
          {"made:torus:around=200,across=20,tube=0.01", "made:torus:around=40,across=200,tube=0.08"}};
}

/// Machines, vehicles, buildings and land.
std::vector<Meeting> of_flow_simulations() {
  const std::string mixer = "mesh/foamyHexMesh/mixerVessel";
  const std::string thermal = "compressible/rhoPimpleFoam/RAS/annularThermalMixer";
  const std::string fan = of_case("incompressible/pimpleFoam/RAS/rotatingFanInRoom", "fan.stl.gz");
  const std::string turbine = of_case("combustion/XiDyMFoam/annularCombustorTurbine", "walls.stl.gz");
  return {{example("motorBike.obj.gz"), example("motorBike-passenger-helmet.obj.gz")},
          with_its_copy(example("propellerTip.obj.gz")),
          with_its_copy(example("flange.stl.gz")),
          {example("cyclone.stl.gz"), example("blob.stl.gz")},
          with_its_copy(example("DTC-scaled.stl.gz")),
          with_its_copy(fan),
          with_its_copy(turbine),
          {of_case("heatTransfer/buoyantSimpleFoam/simpleCarSolarPanel", "simpleCar.stl.gz"),
           of_case("mesh/snappyHexMesh/aerofoilNACA0012_directionalRefinement", "NACA0012.obj.gz")},
          {of_case(thermal, "wall.obj.gz"), of_case(thermal, "shaft.obj.gz")},
          {of_case(mixer, "rawSurfaces/rotating.stl.gz"), of_case(mixer, "rawSurfaces/vessel.stl.gz")},
          {of_case("incompressible/simpleFoam/turbineSiting", "terrain.stl.gz"),
           of_case("mesh/moveDynamicMesh/SnakeRiverCanyon", "AcrossRiver.stl.gz")},
          {of_case("multiphase/interFoam/laminar/sloshingCylinder", "sloshingCylinder.obj.gz"),
           of_case("incompressible/porousSimpleFoam/straightDuctImplicit", "straightDuct.stl.gz")},
          {of_case("incompressible/simpleFoam/rotorDisk", "fixed.obj.gz"),
           of_case("mesh/foamyQuadMesh/OpenCFD", "opencfd_text.stl.gz")},
          {example("membrane-boundaries.stl.gz"), example("blob.stl.gz")},
          {of_case("preProcessing/createZeroDirectory/snappyMultiRegionHeater", "topAir.stl.gz"),
           of_case("preProcessing/createZeroDirectory/snappyMultiRegionHeater", "rightSolid.stl.gz")},
          {of_case("compressible/rhoSimpleFoam/gasMixing/injectorPipe", "walls.stl.gz"),
           of_case("incompressible/simpleFoam/rotorDisk", "rotatingZone.obj.gz")},
          with_its_copy(example("membrane-membrane.stl.gz")),
          with_its_copy(of_case("incompressible/simpleFoam/windAroundBuildings", "buildings.obj.gz")),
          with_its_copy(of_case("incompressible/porousSimpleFoam/straightDuctImplicit", "boundaryAndFaceZones.stl.gz")),
          with_its_copy(of_case("multiphase/interFoam/RAS/mixerVesselAMI", "vessel.stl.gz")),
          with_its_copy(of_case(thermal, "AMI.obj.gz")),
          {example("propellerTip.obj.gz"), example("flange.stl.gz")},
          with_its_copy(example("cyclone.stl.gz")),
          with_its_copy(example("blob.stl.gz")),
          {fan, example("DTC-scaled.stl.gz")},
          with_its_copy(of_case("heatTransfer/buoyantSimpleFoam/simpleCarSolarPanel", "simpleCar.stl.gz")),
          with_its_copy(of_case(mixer, "rawSurfaces/rotating.stl.gz")),
          with_its_copy(of_case("incompressible/simpleFoam/turbineSiting", "terrain.stl.gz"))};
}

/// Designed parts: few and large triangles beside many small ones, sheets, and surfaces inside others.
std::vector<Meeting> of_designed_parts() {
  return {with_its_copy(of_printer("flsun_sr.stl")),
          with_its_copy(of_printer("UltimakerRobot_support.stl")),
          with_its_copy(of_printer("farm2_platform.obj")),
          with_its_copy(of_printer("trimaker_nebula_platform.stl")),
          {of_printer("koonovo_kn5.stl"), of_printer("artillery_genius.stl")},
          with_its_copy(of_printer("zav_mini.stl")),
          with_its_copy(of_printer("ultimaker3_platform.obj")),
          with_its_copy(of_printer("lulzbot_taz_pro_bed.stl")),
          with_its_copy(of_printer("voron0_120_bed.stl")),
          with_its_copy(of_printer("eryone_thinker_platform.obj")),
          {of_printer("hms_platform.obj"), of_printer("wanhao_300_200_platform.obj")},
          with_its_copy(of_printer("tronxy.stl")),
          with_its_copy(of_printer("predator_platform.stl")),
          with_its_copy(of_printer("deltacomb_dc20.stl")),
          with_its_copy(of_printer("atmat_asterion_platform.stl")),
          with_its_copy(of_printer("kingroon_kp3.stl")),
          with_its_copy(of_printer("liquid_platform.stl")),
          with_its_copy(of_slicer("profiles/TriLAB/aqp_bed.stl")),
          with_its_copy(of_slicer("profiles/PrusaResearch/sl1_bed.stl")),
          {of_slicer("profiles/FLSun/QQSP_bed.stl"), of_slicer("shapes/M3x10_screw.stl")},
          with_its_copy(of_slicer("profiles/Anycubic/AKLP_Bed.stl")),
          with_its_copy(of_slicer("profiles/gCreate/gmax15p_bed.stl")),
          with_its_copy(of_slicer("profiles/Voron/printbed-v2-350.stl")),
          with_its_copy(of_slicer("shapes/M3x10_screw.stl")),
          {of_slicer("shapes/OTHER_recycling_symbol.stl"), of_slicer("shapes/torus.stl")},
          with_its_copy("/usr/share/assimp/models/STL/Spider_ascii.stl"),
          with_its_copy("/usr/share/assimp/models/STL/3DSMaxExport.STL")};
}

std::vector<Meeting> of_nested_shells() {
  const std::string dense = "made:bumpy_sphere:frequency=60,bumps=80,width=0.15,seed=9";
  return {
      {"made:bumpy_sphere:frequency=30,bumps=100,width=0.2,height=0.08,seed=51",
       "made:bumpy_sphere:frequency=30,bumps=100,width=0.2,height=0.08,seed=51,scale=0.97", Procedure::nested},
      {"made:bumpy_sphere:frequency=45,bumps=20,width=0.4,height=0.15,seed=52",
       "made:bumpy_sphere:frequency=45,bumps=20,width=0.4,height=0.15,seed=52,scale=0.992", Procedure::nested},
      {"made:peg:around=128,along=60", "made:peg:around=120,along=56,radius=0.0098,length=0.0588", Procedure::nested},
      {"made:torus_knot:p=3,q=4,along=700,across=20", "made:torus_knot:p=3,q=4,along=680,across=18,tube=0.0117",
       Procedure::nested},
      {"made:icosphere:frequency=30", "made:uv_sphere:around=120,down=60,radius=0.0492", Procedure::nested},
      {"made:torus:ring=0.1,tube=0.02,around=220,across=60", "made:torus:ring=0.1,tube=0.0195,around=200,across=50",
       Procedure::nested},
      {bumpy, bumpy + ",scale=0.985", Procedure::nested},
      {"made:icosphere:frequency=40", "made:icosphere:frequency=36,radius=0.0488", Procedure::nested},
      {"made:torus:ring=0.08,tube=0.03,around=180,across=90", "made:torus:ring=0.08,tube=0.0285,around=170,across=80",
       Procedure::nested},
      {dense, dense + ",scale=0.99", Procedure::nested},
      {"made:box:cells=30", "made:box:cells=24,x=0.098,y=0.098,z=0.098", Procedure::nested},
      {knot, "made:torus_knot:along=560,across=18,tube=0.0116", Procedure::nested},
      {"made:torus:around=160,across=80", "made:torus:tube=0.0294,around=150,across=70", Procedure::nested}};
}

}  // namespace

std::vector<Meeting> training_meetings() {
  std::vector<Meeting> all;
  for (const auto& some : {of_made_shapes(), of_flow_simulations(), of_designed_parts(), of_nested_shells()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return present(std::move(all));
}

std::vector<Meeting> held_out_meetings(const std::vector<std::string>& more) {
  const std::string waved = "made:bumpy_sphere:frequency=50,bumps=12,width=0.6,height=0.2,seed=4";
  std::vector<Meeting> meetings = {
      {"made:car_body:triangles=250000,seed=7",
       "made:torus_knot:p=3,q=5,along=900,across=24,ring=0.6,winding=0.25,tube=0.06"},
      {"made:nested_shells:frequency=30,seed=5", "made:torus:around=120,across=60,ring=0.03,tube=0.01"},
      {"made:car_body:triangles=20000,seed=3", "made:terrain:cells=150,side=6,height=0.5,seed=8"},
      {"made:bumpy_sphere:frequency=80,bumps=200,width=0.1,seed=2", "made:gear:teeth=25,flank=6,module=0.004"},
      with_its_copy(example("motorBike.obj.gz")),
      with_its_copy(example("building_wtc2.obj.gz")),
      {example("bullet.stl.gz"), example("wigley.stl.gz")},
      {waved, waved + ",scale=0.99", Procedure::nested},
      {"made:uv_sphere:around=200,down=100", "made:uv_sphere:around=180,down=90,radius=0.0494", Procedure::nested},
      {"made:torus:ring=0.1,tube=0.05,around=200,across=100", "made:torus:ring=0.1,tube=0.0485,around=190,across=90",
       Procedure::nested}};
  meetings = present(std::move(meetings));
  for (const std::string& mesh : more) meetings.push_back(with_its_copy(mesh));  // if absent, that is said
  return meetings;
}

}  // namespace odds::calibration
