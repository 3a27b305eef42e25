#include "brainshift/error.hpp"
#include "brainshift/io.hpp"

namespace brainshift::io {

namespace {

const Field& find(const std::vector<Field>& fields, const std::string& name, const char* place) {
  for (const Field& field : fields) {
    if (field.name == name) return field;
  }
  throw Error(ErrorCode::file, std::string("the file holds no ") + place + " array '" + name + "'");
}

}  // namespace

const Field& Grid::node_field(const std::string& name) const {
  return find(node_fields, name, "node");
}

const Field& Grid::cell_field(const std::string& name) const {
  return find(cell_fields, name, "cell");
}

}  // namespace brainshift::io
