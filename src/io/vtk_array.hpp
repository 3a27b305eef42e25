// One DataArray of a VTK XML file, decoded.
#pragma once

#include <cstddef>

#include "brainshift/io.hpp"
#include "vtk_document.hpp"

namespace brainshift::io {

// Reads `array`, which must hold `rows` tuples of finite numbers; components: 0 for as many as the
// array says. Memory is taken only after the file is seen to be large enough. Throws Error(file).
Field read_array(const VtkDocument& document, pugi::xml_node array, std::size_t rows,
                 std::size_t components = 0);

}  // namespace brainshift::io
