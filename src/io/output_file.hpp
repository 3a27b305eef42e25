// Writes a file as a whole or not at all.
#pragma once

#include <string>

namespace brainshift::io {

// Writes to a temporary beside `path` and renames it: whatever fails, an old file stays whole and
// no temporary is left. Throws Error(file).
void write_whole_file(const std::string& path, const std::string& content);

}  // namespace brainshift::io
