#include "results.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "brainshift/io.hpp"

namespace dbs {
namespace {

nlohmann::json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

double ml(double mm3) { return mm3 / mm3_per_ml; }

nlohmann::json to_json(const StageResult& s) {
  nlohmann::json shifts;
  for (const auto& [name, shift] : s.shifts) shifts[name] = to_json(shift);
  nlohmann::json sides;
  for (int side : {left, right}) {
    const CompartmentState& c = s.fluid[side];
    sides[name_of(side)] = {{"open", c.open}, {"level_mm", c.head},
                            {"air_mL", ml(c.air_volume)}, {"fluid_mL", ml(c.fluid_volume)},
                            {"fluid_lost_mL", ml(c.lost_volume)},
                            {"tissue_mL", ml(c.tissue_volume)},
                            {"largest_surface_motion_mm", s.surface_motion[side]}};
  }
  const SolveReport& r = s.report;
  return {{"stage", s.number}, {"title", s.title}, {"status", to_string(r.status)}, {"message", r.message}, {"load_factor", r.load_factor},
          {"sides", sides}, {"brain_volume_lost_mL", ml(s.tissue_loss)},
          {"midline_shift_mm", s.midline_shift}, {"shift_mm", shifts},
          {"active_contacts", r.active_contacts}, {"largest_violation_mm", r.violation},
          {"residual", r.residual}, {"complementarity", r.complementarity},
          {"smallest_jacobian", r.smallest_jacobian}, {"last_correction_mm", r.last_correction},
          {"energy_uJ", r.energy}, {"newton_iterations", r.iterations},
          {"factorisations", r.factorisations}, {"load_steps", r.load_steps},
          {"seconds", r.seconds}};
}

void write_whole(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Error(ErrorCode::file, temporary + ": cannot be written");
  std::filesystem::rename(temporary, path);
}

std::string csv(const std::vector<StageResult>& stages) {
  std::ostringstream out;
  out.precision(10);
  out << "stage,title,status,level_left_mm,level_right_mm,air_left_mL,air_right_mL,"
         "brain_volume_lost_mL,surface_left_mm,surface_right_mm,midline_shift_mm";
  for (const auto& shift : stages.front().shifts) {
    for (const char* axis : {"x", "y", "z"}) out << ',' << shift.first << '_' << axis << "_mm";
  }
  out << ",active_contacts,violation_mm,newton_iterations,residual,complementarity,"
         "smallest_jacobian,seconds\n";
  for (const StageResult& s : stages) {
    const SolveReport& r = s.report;
    out << s.number << ",\"" << s.title << "\"," << to_string(r.status) << ',' << s.fluid[left].head
        << ',' << s.fluid[right].head << ',' << ml(s.fluid[left].air_volume) << ','
        << ml(s.fluid[right].air_volume) << ',' << ml(s.tissue_loss) << ','
        << s.surface_motion[left] << ',' << s.surface_motion[right] << ',' << s.midline_shift;
    for (const auto& shift : s.shifts) {
      for (int k = 0; k < 3; ++k) out << ',' << shift.second[k];
    }
    out << ',' << r.active_contacts << ',' << r.violation << ',' << r.iterations << ','
        << r.residual << ',' << r.complementarity << ',' << r.smallest_jacobian << ','
        << r.seconds << '\n';
  }
  return out.str();
}

Eigen::MatrixXd contact_forces(const Head& head, Procedure& procedure) {
  Points force = Points::Zero(head.brain.node_count(), 3);
  const auto add = [&](ConstraintId id, const Indices& nodes, const Indices* partners) {
    const ContactState c = procedure.stepper().contact(id);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      force.row(nodes[i]) += c.force.row(Eigen::Index(i));
      if (partners) force.row((*partners)[i]) -= c.force.row(Eigen::Index(i));
    }
  };
  const SceneIds& ids = procedure.ids();
  for (ConstraintId id : {ids.skull, ids.falx[left], ids.falx[right], ids.opposing}) {
    if (id < 0) continue;
    const ConstraintGroup& group = procedure.stepper().constraints().group(id);
    add(id, group.nodes, id == ids.opposing ? &group.partners : nullptr);
  }
  return force;
}

}  // namespace

void print_head(const Head& head, const Options& o) {
  const double volume = head.brain.volume();
  std::printf("head %s: %d nodes, %d tets; meshed %.1f mL, %.3f kg at %.0f kg/m^3\n",
              head.name.c_str(), head.brain.node_count(), head.brain.tet_count(), ml(volume),
              volume * o.density * 1e-9, o.density);
  std::printf("%s, E %.3g kPa, nu %.3g; head elevated %.3g degrees; fluid %s; %s; falx %s\n\n",
              o.law.c_str(), o.young, o.poisson, o.elevation, o.fluid.c_str(),
              o.balanced ? "image in balance with full CSF" : "image free of load",
              o.falx ? "on" : "off");
}

void print_table_header() {
  std::printf("%-20s| level mm  | air mL    | -dV  | surface mm| mid   |%-17s|%-17s|%-17s|\n",
              "", " AC, PC, poles mm", " STN left mm", " STN right mm");
  std::printf("%-20s|%5s%6s|%5s%6s| mL   |%5s%6s| mm    |%5s%4s%4s%4s|%5s%6s%6s|%5s%6s%6s|"
              "contacts viol.mm  it  residual  compl.  min J    s\n",
              "stage", "L", "R", "L", "R", "L", "R", "AC", "PC", "L", "R", "x", "y", "z", "x", "y",
              "z");
}

void print_stage(const StageResult& s) {
  const auto size = [&s](const char* name) { return s.shifts.at(name).norm(); };
  const Vec3 l = s.shifts.at("STN_left"), r = s.shifts.at("STN_right");
  const SolveReport& p = s.report;
  std::printf("%d %-18s|%5.1f%6.1f|%5.1f%6.1f|%6.2f|%5.2f%6.2f|%7.2f|%5.2f%4.1f%4.1f%4.1f|"
              "%5.2f%6.2f%6.2f|%5.2f%6.2f%6.2f|%8d %7.0e %3d %9.1e %7.0e %6.3f %5.1f\n",
              s.number, s.title.c_str(), s.fluid[left].head, s.fluid[right].head,
              ml(s.fluid[left].air_volume), ml(s.fluid[right].air_volume), ml(s.tissue_loss),
              s.surface_motion[left], s.surface_motion[right], s.midline_shift, size("AC"),
              size("PC"), size("frontal_pole_left"), size("frontal_pole_right"), l.x(), l.y(),
              l.z(), r.x(), r.y(), r.z(), p.active_contacts, p.violation, p.iterations, p.residual,
              p.complementarity, p.smallest_jacobian, p.seconds);
  if (!p.converged()) std::printf("  %s: %s\n", to_string(p.status), p.message.c_str());
  std::fflush(stdout);
}

void prepare_folder(const std::string& folder) {
  namespace fs = std::filesystem;
  fs::create_directories(folder);
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("stage_", 0) == 0 || name.rfind("stages.", 0) == 0) fs::remove(entry.path());
  }
}

void write_tables(const std::string& folder, const Head& head, const Options& o,
                  const std::vector<StageResult>& stages) {
  nlohmann::json json;
  json["head"] = {{"name", head.name}, {"nodes", head.brain.node_count()},
                  {"tets", head.brain.tet_count()}, {"volume_mL", ml(head.brain.volume())}};
  json["frame"] = "RAS";
  json["gravity_mm_s2"] = to_json(gravity_of(o.elevation));
  json["options"] = {{"law", o.law}, {"young_kPa", o.young}, {"poisson", o.poisson},
                     {"density_kg_m3", o.density}, {"csf_density_kg_m3", o.csf_density},
                     {"right", o.right}, {"left", o.left}, {"late", o.late},
                     {"elevation_deg", o.elevation}, {"fluid", o.fluid}, {"support", o.support},
                     {"falx", o.falx}, {"skull", o.skull}, {"balanced", o.balanced}};
  for (const StageResult& stage : stages) json["stages"].push_back(to_json(stage));
  write_whole(folder + "/stages.json", json.dump(1) + "\n");
  write_whole(folder + "/stages.csv", csv(stages));
}

std::string write_stage(const std::string& folder, const Head& head, Procedure& procedure,
                        int number) {
  Stepper& stepper = procedure.stepper();
  const Eigen::VectorXd pressure = stepper.fluid_pressure();
  Eigen::VectorXd regions(head.brain.tet_count());
  for (Index t = 0; t < head.brain.tet_count(); ++t) {
    regions[t] = head.brain.regions()[std::size_t(t)];
  }
  io::Grid grid;
  grid.points = stepper.positions();   // deformed
  grid.tets = head.brain.tets();
  grid.node_fields = {{"displacement", procedure.shift(), false},
                      {"pressure", pressure, false},
                      {"wetted", (pressure.array() != 0.0).cast<double>().matrix(), true},
                      {"contact_force", contact_forces(head, procedure), false}};
  grid.cell_fields = {{"region", regions, true}, {"jacobian", stepper.jacobians(), false}};
  const std::string name = "stage_" + std::to_string(number) + ".vtu";
  io::write_vtu(folder + "/" + name, grid);
  return name;
}

}  // namespace dbs
