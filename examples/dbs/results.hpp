// What the example leaves behind: a table on the screen, JSON, CSV, and VTU files.
#pragma once

#include <string>
#include <vector>

#include "procedure.hpp"

namespace dbs {

void print_head(const Head& head, const Options& options);
void print_table_header();
void print_stage(const StageResult& stage);

// Makes the folder, and takes the results of an earlier run out of it.
void prepare_folder(const std::string& folder);
// stages.json and stages.csv; written whole or not at all.
void write_tables(const std::string& folder, const Head& head, const Options& options,
                  const std::vector<StageResult>& stages);
// stage_N.vtu, the deformed mesh: displacement since stage 0, pressure, wetted, contact_force on
// nodes; region, jacobian on tets. Returns the file name.
std::string write_stage(const std::string& folder, const Head& head, Procedure& procedure,
                        int number);

}  // namespace dbs
