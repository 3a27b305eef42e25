#include "options.hpp"

#include <charconv>
#include <cmath>

#include <CLI/CLI.hpp>

namespace dbs {

Loss parse_loss(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  const bool number = error == std::errc() && std::isfinite(value);
  if (number && value < 0.0) {
    throw Error(ErrorCode::fluid_volume, "'" + text + "' is negative: fluid is lost, not gained");
  }
  if (number && unit == "mL") return {FluidLaw::lost_volume, value * mm3_per_ml};
  if (number && unit == "mL-air") return {FluidLaw::air_volume, value * mm3_per_ml};
  if (number && unit == "mm") return {FluidLaw::level, value};
  throw Error(ErrorCode::invalid_argument,
              "'" + text + "' is no loss of fluid: write 20mL (fluid), 20mL-air or 35mm (level)");
}

Options preset(const std::string& name) {
  Options o;
  o.preset = name;
  if (name == "default") return o;
  if (name != "paper-2011") {
    throw Error(ErrorCode::invalid_argument,
                "unknown preset '" + name + "'; known: default, paper-2011");
  }
  o.mass = 1.4;
  o.balanced = false;
  o.fluid = "separate";
  o.support = "fixed+optic";
  o.tether = 0.0;
  return o;
}

namespace {

// The preset is read before the other options, which change it.
std::string preset_in(int argc, char** argv) {
  std::string name = "default";
  CLI::App app;
  app.allow_extras();
  app.set_help_flag();
  app.add_option("--preset", name);
  app.parse(argc, argv);
  return name;
}

void add_electrodes(CLI::App& app, Options& o) {
  const auto group = app.add_option_group("Electrodes");
  group->add_option("--sides", o.sides, "that are operated on: both, right, left")
      ->capture_default_str()->check(CLI::IsMember({"both", "right", "left"}));
  group->add_option("--first", o.first, "of both sides")
      ->capture_default_str()->check(CLI::IsMember({"right", "left"}));
  group->add_flag("--recover-between,!--one-session", o.recover_between,
                  "the fluid comes back before the second side is operated on");
  group->add_option("--target", o.target, "landmark without its side: STN, GPi (default: the plan "
                                          "that comes with the head)");
  group->add_option("--target-right", o.target_right, "x y z, mm RAS")->expected(3);
  group->add_option("--target-left", o.target_left, "x y z, mm RAS")->expected(3);
  group->add_option("--sagittal", o.sagittal, "angle of the trajectory above horizontal, degrees");
  group->add_option("--lateral", o.lateral, "angle of the trajectory to the side, degrees");
  group->add_option("--aim", o.aim, "at the planned point of the skull frame, or where that point "
                                    "of the tissue has gone")
      ->capture_default_str()->check(CLI::IsMember({"skull", "tissue"}));
  group->add_option("--offset-right", o.offset_right, "of the aim from the target, x y z, mm RAS: to "
                                                      "meet a shift foreseen")->expected(3);
  group->add_option("--offset-left", o.offset_left, "the same on the left")->expected(3);
  group->add_option("--contact", o.contact, "that is to lie at the target, from the tip; 0: the tip")
      ->capture_default_str()->check(CLI::Range(0, 64));
  std::string names;
  for (const std::string& name : device_names()) names += (names.empty() ? "" : ", ") + name;
  group->add_option("--lead", o.lead, names)->capture_default_str();
  group->add_option("--test-electrode", o.test_electrode,
                    "tests in the lead's place, exchanged before the cannula leaves");
  group->add_option("--bending", o.bending, "EI of the lead, N mm^2 (default: the table's)");
  group->add_option("--friction", o.friction, "largest shear between device and tissue, kPa")
      ->capture_default_str();
  group->add_flag("--local-give", o.local_give, "ties give way by what tets wider than the device leave "
                  "out of the tissue's softness");
  group->add_option("--tip-hold", o.tip_hold, "friction besides, at the tip, once the cannula has "
                                              "left, mN")->capture_default_str();
  group->add_option("--slack", o.slack, "the wire slides this far at the burr hole before the skull "
                                        "holds it, mm")->capture_default_str();
  group->add_flag("--clamped,!--hinged", o.clamped, "the wire at the burr hole");
  group->add_option("--cannula-depth", o.cannula_depth, "the cannula ends short of the target, mm")
      ->capture_default_str();
  group->add_flag("--elastic-cannula,!--rigid-cannula", o.elastic_cannula,
                  "a steel beam held at the burr hole, or rigid");
  group->add_flag("--devices,!--no-devices", o.devices, "with electrodes, or only the loss of fluid");
}

}  // namespace

int parse(int argc, char** argv, Options& o) {
  try {
    o = preset(preset_in(argc, argv));
  } catch (const CLI::ParseError&) {
    // The parser below says what is wrong.
  }
  CLI::App app{"A deep brain stimulation procedure: fluid is lost, a cannula and an electrode go in on "
               "the right, then on the left, and the fluid comes back in the months after.", "dbs"};
  std::string name;
  app.add_option("--preset", name, "default, or paper-2011: what other options start from");
  app.add_option("--head", o.head, "folder of the head (brain.vtu, cavity.vtp, falx.vtp, head.json)")
      ->required();
  app.add_option("--scale", o.scale, "of the head's lengths, about AC")
      ->capture_default_str()->check(CLI::Range(0.1, 10.0));
  app.add_option("--gap", o.gap, "of fluid more between brain and skull, mm")
      ->capture_default_str()->check(CLI::Range(0.0, 20.0));
  app.add_option("--out", o.out, "folder for results")->capture_default_str();
  app.add_option("--law", o.law, "linear, corotational, st_venant_kirchhoff, stable_neo_hookean or "
                 "log_neo_hookean")
      ->capture_default_str();
  app.add_option("--element", o.element, "linear tets, nodal (linear, the change of volume averaged "
                 "around nodes) or quadratic")
      ->capture_default_str()->check(CLI::IsMember({"linear", "nodal", "quadratic"}));
  app.add_option("--young", o.young, "Young's modulus of the brain, kPa")->capture_default_str();
  app.add_option("--poisson", o.poisson, "Poisson's ratio of the brain")->capture_default_str();
  app.add_option("--density", o.density, "of the brain, kg/m^3")->capture_default_str();
  app.add_option("--materials", o.materials, "JSON file: parts of the brain by their labels, with materials of "
                 "their own (default: the head's materials.json, where it has one)");
  app.add_option("--mass", o.mass, "of the meshed brain, kg; sets the density");
  app.add_option("--csf-density", o.csf_density, "of the fluid, kg/m^3")->capture_default_str();
  app.add_option("--right", o.right, "lost on the right: 20mL (fluid), 20mL-air, or 35mm (level)")
      ->capture_default_str();
  app.add_option("--left", o.left, "lost on the left")->capture_default_str();
  app.add_option("--late", o.late, "part of a side's loss that comes during testing")
      ->capture_default_str()->check(CLI::Range(0.0, 1.0));
  app.add_option("--imaging-elevation", o.imaging_elevation,
                 "of the head when the first and the last image were taken (default: as in surgery)")
      ->check(CLI::Range(-90.0, 90.0));
  app.add_option("--elevation", o.elevation, "of the head above horizontal, degrees")
      ->capture_default_str()->check(CLI::Range(-90.0, 90.0));
  app.add_option("--fluid", o.fluid, "separate: each side its level; communicating: one")
      ->capture_default_str()->check(CLI::IsMember({"separate", "communicating"}));
  app.add_option("--support", o.support,
                 "how the brainstem is held at its lower end, and the optic nerves if named")
      ->capture_default_str()
      ->check(CLI::IsMember({"elastic", "fixed", "elastic+optic", "fixed+optic"}));
  app.add_option("--tether", o.tether, "springs between the outside of the brain and the skull, "
                                       "kPa/mm")
      ->capture_default_str()->check(CLI::Range(0.0, 1e3));
  app.add_option("--still", o.still, "a half of the brain that is held where it is: left, right")
      ->check(CLI::IsMember({"left", "right"}));
  app.add_option("--time-step", o.time_step, "s; each stage goes on in time until it rests, instead of "
                                             "one balance of forces")
      ->check(CLI::Range(0.0, 10.0));
  add_electrodes(app, o);
  app.add_flag("--falx,!--no-falx", o.falx, "with or without the falx (hemispheres still touch)");
  app.add_flag("--skull,!--no-skull", o.skull, "with or without contact with skull and tentorium");
  app.add_flag("--balanced,!--free", o.balanced,
               "the image is in balance with gravity and full fluid, or free of load");
  app.add_flag("--plan", o.plan, "instead of one procedure: aim, depth, slack and order of sides that "
                                 "leave the electrodes nearest their targets");
  app.add_flag("--files,!--no-files", o.files, "write results to --out");
  app.add_flag("--vtk,!--no-vtk", o.vtk, "VTU and VTP files among them");
  app.add_option("--report", o.report, "FILE: one page about the results too, with tables, charts and pictures, "
                 "that fetches nothing");
  app.add_flag("--estimate", o.estimate, "estimate by how much the mesh has the landmarks wrong (stages.json)");
  app.add_option("--accuracy", o.accuracy,
                 "mm: solves end where less than that is left open; 0: as exact as they can be")
      ->check(CLI::Range(0.0, 10.0));
  app.add_option("--threads", o.threads, "of the solver; no result depends on it")
      ->capture_default_str()->check(CLI::Range(1, 256));
  app.add_option("--progress", o.progress, "on stderr. auto: a line where that is a terminal, else "
                 "nothing; line; json: an object per line; none")
      ->capture_default_str()->check(CLI::IsMember({"auto", "line", "json", "none"}));
  app.add_flag("--quiet", o.quiet, "no progress, whatever --progress says");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e);
  }
  parse_loss(o.right);
  parse_loss(o.left);
  law_from_name(o.law);
  device_data(o.lead);
  if (!o.test_electrode.empty()) device_data(o.test_electrode);
  return -1;
}

}  // namespace dbs
