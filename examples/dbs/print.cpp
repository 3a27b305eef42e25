// Tables on the screen.
#include <cmath>
#include <cstdio>

#include "results.hpp"

namespace dbs {
namespace {

double ml(double mm3) { return mm3 / mm3_per_ml; }

// Left, right, up to the sign of the nearest: what a surgeon would say of a direction.
std::string direction_word(const Vec3& v) {
  if (v.norm() < 0.5) return "-";
  Eigen::Index axis;
  v.cwiseAbs().maxCoeff(&axis);
  static const char* const words[3][2] = {{"left", "right"}, {"posterior", "anterior"},
                                          {"inferior", "superior"}};
  return words[axis][v[axis] > 0.0];
}

void print_lead(const StageResult& stage, int side) {
  const LeadResult& r = *stage.lead[side];
  const DeviceState& d = r.state;
  const Vec3 tip = d.nodes.row(0).transpose(), off = tip - r.trajectory.target;
  const auto show = [](const std::optional<Retraction>& x, double Retraction::*frame) {
    if (!x || std::isnan(*x.*frame)) return std::string("      -");
    char text[32];
    std::snprintf(text, sizeof text, "%7.3f", *x.*frame);
    return std::string(text);
  };
  double track = 0.0;
  for (Eigen::Index p = 0; p < d.path_forces.rows(); ++p) {
    track = std::max(track, d.path_forces.row(p).norm());
  }
  const bool bent = d.bow > 1e-6;   // mm; below it place and direction are rounding
  std::printf("%-3s %-5s %-17s|%6.2f%6.2f%6.2f|%5.2f|%7.3f%6.1f  %-9s|%7s%7s|%7s%7s|%8.1f%8.1f\n",
              stage.label.c_str(), name_of(side), d.name.c_str(), off.x(), off.y(), off.z(),
              r.largest_track_motion, d.bow,
              bent ? d.bow_arc : 0.0, bent ? direction_word(d.bow_direction).c_str() : "-",
              show(r.since_cannula_left, &Retraction::skull).c_str(),
              show(r.since_cannula_left, &Retraction::tissue).c_str(),
              show(r.since_surgery, &Retraction::skull).c_str(),
              show(r.since_surgery, &Retraction::tissue).c_str(), d.anchor_force.norm(), track);
}

// Materials of parts; those of the options are told beside.
void print_parts(const Head& head, const Options& o) {
  if (head.parts.empty()) return;
  const BrainMaterials brain = materials_of(head, o);
  for (std::size_t i = 0; i < head.parts.size(); ++i) {
    const Index region = BrainMaterials::region_of_part(i);
    const Material& found = brain.of(region);
    std::printf("%s, %.1f mL: %s, E %.3g kPa, nu %.3g, %.0f kg/m^3\n", head.parts[i].name.c_str(),
                ml(brain.mesh.volume(region)), to_string(found.law()), found.young(), found.poisson(),
                1e9 * found.density());
  }
}

}  // namespace

void print_head(const Head& head, const Options& o) {
  const double volume = head.brain.volume(), mass = materials_of(head, o).mass();
  std::printf("preset %s; head %s: %d nodes, %d tets; meshed %.1f mL, %.3f kg at %.0f kg/m^3\n",
              o.preset.c_str(), head.name.c_str(), head.brain.node_count(), head.brain.tet_count(), ml(volume),
              mass, 1e9 * mass / volume);
  if (o.scale != 1.0) std::printf("lengths times %.4g about AC; ", o.scale);
  std::printf("%s, E %.3g kPa, nu %.3g; head elevated %.3g degrees; fluid %s; %s; falx %s\n",
              o.law.c_str(), o.young, o.poisson, o.elevation, o.fluid.c_str(),
              o.balanced ? "image in balance with full CSF" : "image free of load",
              o.falx ? "on" : "off");
  print_parts(head, o);
  std::printf("levels are heights along -gravity from the frame's origin; shifts count from stage 0, "
              "in mm\n");
  if (o.devices) {
    const double bending = o.bending > 0.0 ? o.bending : device_data(o.lead).bending * 1e-3;
    std::printf("lead %s, EI %.3g N mm^2, shear at most %.3g kPa, slack %.3g mm; %s cannula to "
                "%.3g mm from the target; aimed at the %s\n",
                o.lead.c_str(), bending, o.friction, o.slack, o.elastic_cannula ? "elastic" : "rigid",
                o.cannula_depth, o.aim == "skull" ? "planned point" : "point of the tissue");
  }
  std::printf("\n");
}

void print_table_header() {
  std::printf("%-22s| level mm  | air mL    | -dV  | surface mm| mid   |%-17s|%-17s|%-17s|\n",
              "", " AC, PC, poles mm", " STN left mm", " STN right mm");
  std::printf("%-22s|%5s%6s|%5s%6s| mL   |%5s%6s| mm    |%5s%4s%4s%4s|%5s%6s%6s|%5s%6s%6s|"
              "contacts viol.mm  it  residual  compl.  min J    s\n",
              "stage", "L", "R", "L", "R", "L", "R", "AC", "PC", "L", "R", "x", "y", "z", "x", "y",
              "z");
}

void print_stage(const StageResult& s) {
  const auto size = [&s](const char* name) { return s.shifts.at(name).norm(); };
  const Vec3 l = s.shifts.at("STN_left"), r = s.shifts.at("STN_right");
  const SolveReport& p = s.report;
  std::printf("%-2s %-19s|%5.1f%6.1f|%5.1f%6.1f|%6.2f|%5.2f%6.2f|%7.2f|%5.2f%4.1f%4.1f%4.1f|"
              "%5.2f%6.2f%6.2f|%5.2f%6.2f%6.2f|%8d %7.0e %3d %9.1e %7.0e %6.3f %5.1f\n",
              s.label.c_str(), s.title.c_str(), s.fluid[left].head, s.fluid[right].head,
              ml(s.fluid[left].air_volume), ml(s.fluid[right].air_volume), ml(s.tissue_loss),
              s.surface_motion[left], s.surface_motion[right], s.midline_shift, size("AC"),
              size("PC"), size("frontal_pole_left"), size("frontal_pole_right"), l.x(), l.y(),
              l.z(), r.x(), r.y(), r.z(), p.active_contacts, p.violation, p.iterations, p.residual,
              p.complementarity, p.smallest_jacobian, p.seconds);
  if (!s.remark.empty()) std::printf("   note: %s\n", s.remark.c_str());
  if (!p.converged()) std::printf("   %s: %s\n", to_string(p.status), p.message.c_str());
  std::fflush(stdout);
}

void print_stage_notes() {
  std::printf("\n-dV: volume the brain has lost; below 0 it has swollen, as less fluid presses on it. Air and "
              "swelling\ntogether take the place of the fluid that is lost. Surface: largest motion of a half's "
              "outside. Mid: mean\nmotion of the midline beside the falx, to the right. From contacts to min J, "
              "the certificate of balance:\nrows in contact, deepest penetration, Newton iterations, relative "
              "residual and complementarity, smallest\ndet F of a tet. s: seconds.\n");
}

void print_interrupt(const std::vector<StageResult>& finished, const Stage& stage) {
  std::printf("interrupted in stage %s (%s); ", stage.label.c_str(), stage.title.c_str());
  if (finished.empty()) {
    std::printf("no stage was finished, nothing is written\n");
  } else {
    std::printf("the results are those of the stages up to %s\n", finished.back().label.c_str());
  }
}

void print_electrodes(const std::vector<StageResult>& stages) {
  bool any = false;
  for (const StageResult& s : stages) any = any || s.lead[left] || s.lead[right];
  if (!any) return;
  std::printf("\nElectrodes, in the frame of the skull; mm and mN. D: motion of the tip along its "
              "trajectory, positive\ntowards the burr hole, against the skull and against the tissue "
              "that was at the tip. Force\nat the skull (of the frame while the cannula is in), and of "
              "the strongest tie to tissue.\n\n");
  std::printf("%-27s| tip from target  |track| bow: size, from |%-15s|%-14s| force, mN\n", "",
              " D since cannula", " D since the");
  std::printf("%-27s|%6s%6s%6s|motn.| tip, towards      |%-15s|%-14s|  skull     tie\n",
              "stage side  device", "x", "y", "z", " left: sk.  tis.", " surgery: tis.");
  for (const StageResult& s : stages) {
    for (int side : {right, left}) {
      if (s.lead[side]) print_lead(s, side);
    }
  }
}

}  // namespace dbs
