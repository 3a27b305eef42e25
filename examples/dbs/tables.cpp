// JSON and CSV.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

#include "brainshift/version.hpp"
#include "results.hpp"

namespace dbs {
namespace {

double ml(double mm3) { return mm3 / mm3_per_ml; }

nlohmann::json number(double value) {   // JSON has no NaN
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::json to_json(const Points& points) {
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    rows.push_back(to_json(Vec3(points.row(i).transpose())));
  }
  return rows;
}

nlohmann::json to_json(const std::optional<Retraction>& r) {
  if (!r) return {};
  return {{"skull_mm", number(r->skull)}, {"tissue_mm", number(r->tissue)}};
}

nlohmann::json to_json(const LeadResult& r) {
  const DeviceState& d = r.state;
  nlohmann::json arcs = nlohmann::json::array();
  for (Eigen::Index p = 0; p < d.path_arcs.size(); ++p) arcs.push_back(number(d.path_arcs[p]));
  return {{"device", d.name}, {"in_cannula", r.in_cannula},
          {"off_target_mm", to_json(r.off_target)}, {"target_mm", to_json(r.trajectory.target)}, {"outward", to_json(r.trajectory.outward)},
          {"burr_hole_mm", to_json(r.trajectory.inner_table)},
          {"tip_mm", to_json(Vec3(d.nodes.row(0).transpose()))}, {"nodes_mm", to_json(d.nodes)},
          {"contacts_mm", to_json(d.contact_centres)},
          {"bow_mm", d.bow}, {"bow_from_tip_mm", d.bow_arc},
          {"bow_direction", to_json(d.bow_direction)},
          {"wire_out_mm", d.slide},
          {"force_of_skull_or_frame_mN", to_json(d.anchor_force)},
          {"track_mm", to_json(d.path)}, {"track_arc_mm", arcs},
          {"track_force_on_tissue_mN", to_json(d.path_forces)},
          {"track_mean_motion_mm", to_json(r.track_motion)},
          {"track_largest_motion_across_mm", r.largest_track_motion},
          {"largest_tie_gap_mm", d.largest_tie_gap},
          {"D_since_cannula_left", to_json(r.since_cannula_left)},
          {"D_since_end_of_surgery", to_json(r.since_surgery)}};
}

nlohmann::json to_json(const SolveReport& r) {
  return {{"status", to_string(r.status)}, {"message", r.message}, {"load_factor", r.load_factor},
          {"active_contacts", r.active_contacts}, {"largest_violation_mm", r.violation},
          {"residual", r.residual}, {"complementarity", r.complementarity},
          {"smallest_jacobian", r.smallest_jacobian}, {"last_correction_mm", r.last_correction},
          {"coupling_rows", r.coupling_rows}, {"tie_gap_mm", r.tie_gap}, {"energy_uJ", r.energy},
          {"newton_iterations", r.iterations}, {"factorisations", r.factorisations},
          {"load_steps", r.load_steps}, {"seconds", r.seconds}};
}

nlohmann::json to_json(const StageResult& s) {
  nlohmann::json shifts, sides, leads = nlohmann::json::object();
  for (const auto& [name, shift] : s.shifts) shifts[name] = to_json(shift);
  for (int side : {left, right}) {
    const CompartmentState& c = s.fluid[side];
    sides[name_of(side)] = {{"open", c.open}, {"level_mm", c.head},
                            {"air_mL", ml(c.air_volume)}, {"fluid_mL", ml(c.fluid_volume)},
                            {"fluid_lost_mL", ml(c.lost_volume)},
                            {"tissue_mL", ml(c.tissue_volume)},
                            {"largest_surface_motion_mm", s.surface_motion[side]}};
    if (s.lead[side]) leads[name_of(side)] = to_json(*s.lead[side]);
  }
  return {{"stage", s.label}, {"title", s.title}, {"remark", s.remark}, {"sides", sides},
          {"brain_volume_lost_mL", ml(s.tissue_loss)}, {"midline_shift_mm", s.midline_shift},
          {"shift_mm", shifts}, {"error_estimate_mm", s.errors}, {"electrodes", leads},
          {"solve", to_json(s.report)}};
}

nlohmann::json to_json(const Options& o) {
  return {{"preset", o.preset}, {"scale", o.scale}, {"gap_mm", o.gap}, {"mass_kg", o.mass},
          {"law", o.law}, {"element", o.element}, {"young_kPa", o.young}, {"poisson", o.poisson},
          {"density_kg_m3", o.density}, {"csf_density_kg_m3", o.csf_density}, {"right", o.right},
          {"left", o.left}, {"late", o.late}, {"elevation_deg", o.elevation},
          {"imaging_elevation_deg", imaging_elevation(o)}, {"fluid", o.fluid},
          {"support", o.support}, {"tether_kPa_mm", o.tether},
          {"still", o.still}, {"time_step_s", o.time_step}, {"falx", o.falx}, {"skull", o.skull}, {"balanced", o.balanced},
          {"sides", o.sides}, {"first", o.first}, {"recover_between", o.recover_between}, {"target", o.target}, {"target_right_mm", o.target_right},
          {"target_left_mm", o.target_left}, {"sagittal_deg", number(o.sagittal)},
          {"lateral_deg", number(o.lateral)}, {"devices", o.devices}, {"aim", o.aim}, {"offset_right_mm", o.offset_right},
          {"offset_left_mm", o.offset_left}, {"contact", o.contact}, {"lead", o.lead},
          {"test_electrode", o.test_electrode}, {"bending_Nmm2", o.bending},
          {"friction_kPa", o.friction}, {"local_give", o.local_give}, {"tip_hold_mN", o.tip_hold}, {"slack_mm", o.slack}, {"clamped", o.clamped},
          {"cannula_depth_mm", o.cannula_depth}, {"elastic_cannula", o.elastic_cannula}};
}

// Of the parts of the brain that have one of their own.
nlohmann::json materials_json(const Head& head, const Options& o) {
  nlohmann::json rows = nlohmann::json::array();
  if (head.parts.empty()) return rows;
  const BrainMaterials brain = materials_of(head, o);
  for (std::size_t i = 0; i < head.parts.size(); ++i) {
    const Index region = BrainMaterials::region_of_part(i);
    const Material& m = brain.of(region);
    rows.push_back({{"name", head.parts[i].name}, {"volume_mL", ml(brain.mesh.volume(region))},
                    {"law", to_string(m.law())}, {"young_kPa", m.young()}, {"poisson", m.poisson()},
                    {"density_kg_m3", 1e9 * m.density()}});
  }
  return rows;
}

std::string stages_csv(const std::vector<StageResult>& stages) {
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
    out << s.label << ",\"" << s.title << "\"," << to_string(r.status) << ',' << s.fluid[left].head
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

// One row per stage and side: tip, retraction, bow, force of skull (or frame) on the device, contact centres.
std::string electrodes_csv(const std::vector<StageResult>& stages) {
  std::ostringstream out;
  out.precision(10);
  out << "stage,side,device,in_cannula,tip_x_mm,tip_y_mm,tip_z_mm,D_skull_since_cannula_mm,"
         "D_tissue_since_cannula_mm,D_skull_since_surgery_mm,D_tissue_since_surgery_mm,bow_mm,"
         "bow_from_tip_mm,bow_x,bow_y,bow_z,skull_force_x_mN,skull_force_y_mN,skull_force_z_mN,"
         "contacts_mm\n";
  const auto put = [&out](const Vec3& v) { out << ',' << v.x() << ',' << v.y() << ',' << v.z(); };
  const auto put_retraction = [&out](const std::optional<Retraction>& r) {
    for (double value : {r ? r->skull : std::nan(""), r ? r->tissue : std::nan("")}) {
      out << ',';
      if (std::isfinite(value)) out << value;
    }
  };
  for (const StageResult& s : stages) {
    for (int side : {right, left}) {
      if (!s.lead[side]) continue;
      const LeadResult& r = *s.lead[side];
      out << s.label << ',' << name_of(side) << ",\"" << r.state.name << "\"," << r.in_cannula;
      put(r.state.nodes.row(0).transpose());
      put_retraction(r.since_cannula_left);
      put_retraction(r.since_surgery);
      out << ',' << r.state.bow << ',' << r.state.bow_arc;
      put(r.state.bow_direction);
      put(r.state.anchor_force);
      out << ",\"";
      for (Eigen::Index c = 0; c < r.state.contact_centres.rows(); ++c) {
        out << (c ? "; " : "") << r.state.contact_centres.row(c);
      }
      out << "\"\n";
    }
  }
  return out.str();
}

}  // namespace

void write_whole(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Error(ErrorCode::file, temporary + ": cannot be written");
  std::filesystem::rename(temporary, path);
}

void prepare_folder(const std::string& folder) {
  namespace fs = std::filesystem;
  static const std::regex mine("stage_[0-9][a-c]?(_(left|right)(_track)?)?[.](vtu|vtp|png)|"
                               "(sheet|figure_lead)_(left|right)[.]png|figure_shift[.]png|"
                               "stages([.]electrodes)?[.]pvd|stages[.](json|csv)|electrodes[.]csv|plan[.]json");
  fs::create_directories(folder);
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (std::regex_match(entry.path().filename().string(), mine)) old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove(path);
}

void write_tables(const std::string& folder, const Head& head, const Options& o,
                  const std::vector<Stage>& plan, const std::vector<StageResult>& stages) {
  nlohmann::json json;
  json["library"] = "libbrainshift " BRAINSHIFT_VERSION;
  json["head"] = {{"name", head.name}, {"nodes", head.brain.node_count()},
                  {"tets", head.brain.tet_count()}, {"volume_mL", ml(head.brain.volume())}};
  json["frame"] = "RAS";
  json["gravity_mm_s2"] = to_json(gravity_of(o.elevation));
  json["options"] = to_json(o);
  json["materials"] = materials_json(head, o);
  for (const Stage& stage : plan) json["plan"].push_back(stage.label);   // finished or not
  for (const StageResult& stage : stages) json["stages"].push_back(to_json(stage));
  write_whole(folder + "/stages.json", json.dump(1) + "\n");
  write_whole(folder + "/stages.csv", stages_csv(stages));
  write_whole(folder + "/electrodes.csv", electrodes_csv(stages));
}

}  // namespace dbs
