// What the example leaves behind: tables on the screen, JSON, CSV, and VTK files.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "procedure.hpp"

namespace dbs {

void print_head(const Head& head, const Options& options);
void print_table_header();
void print_stage(const StageResult& stage);
// What the columns of that table are.
void print_stage_notes();
// Tips, bows, forces, and retraction of each electrode from stage to stage.
void print_electrodes(const std::vector<StageResult>& stages);

// What was written after an interrupt, and in which stage that came.
void print_interrupt(const std::vector<StageResult>& finished, const Stage& stage);

// Makes the folder, and takes the results of an earlier run out of it.
void prepare_folder(const std::string& folder);
// A file, whole or not at all.
void write_whole(const std::string& path, const std::string& text);
// stages.json, stages.csv and electrodes.csv of the stages so far; each written whole or not at all.
void write_tables(const std::string& folder, const Head& head, const Options& options,
                  const std::vector<Stage>& plan, const std::vector<StageResult>& stages);

using Series = std::vector<std::pair<double, std::string>>;   // time and file name
// stage_N.vtu, the deformed mesh: displacement since stage 0, pressure, wetted, contact_force on
// nodes; region, jacobian on tets. Returns the file name.
std::string write_stage(const std::string& folder, const Head& head, const Procedure& procedure,
                        const std::string& label);
// stage_N_right.vtp: the device as a tube (arc_mm, contact number or 0); stage_N_right_track.vtp:
// its track in tissue (arc_mm, and the force on the tissue, mN, at each point where they are tied).
std::vector<std::string> write_electrodes(const std::string& folder, const Procedure& procedure,
                                          const StageResult& stage);

}  // namespace dbs
