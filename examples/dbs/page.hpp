// --report: a page about the results, made by report.py on the system's Python, whose VTK draws it.
#pragma once

#include "options.hpp"

namespace dbs {

// Throws brainshift::Error where no page can come of the run, before it has taken its time.
void check_page(const Options& options);
// Throws brainshift::Error where report.py fails; what it says goes to stderr.
void write_page(const Options& options);

}  // namespace dbs
