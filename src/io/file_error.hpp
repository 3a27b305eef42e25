// Every failure of this folder is Error(file), one sentence that begins with the path.
#pragma once

#include <string>

#include "brainshift/error.hpp"

namespace brainshift::io {

[[noreturn]] inline void fail(const std::string& path, const std::string& what) {
  throw Error(ErrorCode::file, path + ": " + what);
}

}  // namespace brainshift::io
