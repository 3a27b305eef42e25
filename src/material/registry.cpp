#include "material/registry.hpp"

#include <string>

#include "brainshift/error.hpp"
#include "material/laws.hpp"

namespace brainshift {
namespace {

struct Entry {
  Law law;
  const char* name;
  const char* alias;  // nullptr: none
  const LawFunctions& functions;
};

const Entry entries[] = {
    {Law::linear, "linear", nullptr, linear_law},
    {Law::corotational, "corotational", nullptr, corotational_law},
    {Law::st_venant_kirchhoff, "st_venant_kirchhoff", "stvk", st_venant_kirchhoff_law},
    {Law::stable_neo_hookean, "stable_neo_hookean", "snh", stable_neo_hookean_law},
    {Law::log_neo_hookean, "log_neo_hookean", "lnh", log_neo_hookean_law},
};

const Entry* find(Law law) {
  for (const Entry& entry : entries) {
    if (entry.law == law) return &entry;
  }
  return nullptr;
}

}  // namespace

const LawFunctions& law_functions(Law law) {
  const Entry* entry = find(law);
  if (!entry) {
    throw Error(ErrorCode::invalid_argument,
                "Material: there is no law number " + std::to_string(static_cast<int>(law)));
  }
  return entry->functions;
}

const char* to_string(Law law) {
  const Entry* entry = find(law);
  return entry ? entry->name : "unknown";
}

Law law_from_name(const std::string& name) {
  std::string known;
  for (const Entry& entry : entries) {
    if (name == entry.name || (entry.alias && name == entry.alias)) return entry.law;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
    if (entry.alias) known += " (" + std::string(entry.alias) + ")";
  }
  throw Error(ErrorCode::invalid_argument, "unknown law '" + name + "'; known: " + known);
}

}  // namespace brainshift
