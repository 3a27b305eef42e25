// Handles that are NULL, of another type, or none at all: every function, every handle argument.
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <thread>

#include "handle_probes.hpp"

namespace brainshift::test {
namespace {

class Handles : public testing::Test {
 public:
  World w;
  Harmless s;
  Made made;
  std::map<std::string, void*> handles{{"context", w.context}, {"mesh", w.mesh},
                                       {"surface", w.surface}, {"scene", w.scene},
                                       {"device", w.device},   {"stepper", w.stepper},
                                       {"snapshot", w.snapshot}};

  std::vector<Probe> all() { return probes(w, s, made); }

  // What a callback does that calls back: every function, with good handles.
  void expect_all_busy() {
    std::vector<Probe> probes = all();
    for (const Probe& p : probes_of_destroy())
      if (changes_later(p.type)) probes.push_back(p);
    for (const Probe& p : probes) {
      if (std::string(p.function) == "brs_context_set_cancel") continue;  // the one that may come
      EXPECT_EQ(p.call(handles.at(p.type)), BRS_ERROR_BUSY) << p.function;
    }
  }
  // Not so the values that may be destroyed at any time.
  static bool changes_later(const std::string& type) {
    return type == "context" || type == "scene" || type == "stepper";
  }
};

TEST_F(Handles, NullIsRefusedByEveryFunctionAndFineToDestroy) {
  for (const Probe& p : all()) EXPECT_EQ(p.call(nullptr), BRS_ERROR_NULL) << p.function;
  for (const Probe& p : probes_of_destroy()) EXPECT_EQ(p.call(nullptr), BRS_OK) << p.function;
  EXPECT_STREQ(brs_context_message(nullptr), "the context is NULL");
}

TEST_F(Handles, OfAnotherTypeAreRefusedByEveryFunctionWithAMessage) {
  std::vector<Probe> probes = all();
  for (const Probe& p : probes_of_destroy()) probes.push_back(p);
  for (const Probe& p : probes) {
    for (const auto& [type, handle] : handles) {
      if (type == p.type) continue;
      EXPECT_EQ(p.call(handle), BRS_ERROR_HANDLE) << p.function << " of a " << type;
      if (std::string(p.function) == "brs_context_set_cancel") continue;  // never touches messages
      EXPECT_EQ(w.message(), "a " + type + " is given where a " + p.type + " is expected")
          << p.function;
    }
  }
}

TEST_F(Handles, ThatAreNoHandlesAreRefusedByEveryFunction) {
  alignas(16) unsigned char zeros[256] = {};
  std::vector<Probe> probes = all();
  for (const Probe& p : probes_of_destroy()) probes.push_back(p);
  for (const Probe& p : probes) EXPECT_EQ(p.call(zeros), BRS_ERROR_HANDLE) << p.function;
}

TEST_F(Handles, OfTheRightTypeAreTakenByEveryProbe) {
  // Otherwise the tests above could pass for another reason.
  for (const Probe& p : all()) {
    const brs_status status = p.call(handles.at(p.type));
    EXPECT_NE(status, BRS_ERROR_HANDLE) << p.function << ": " << w.message();
    EXPECT_NE(status, BRS_ERROR_NULL) << p.function << ": " << w.message();
    made.clear();
  }
}

TEST_F(Handles, OfAContextInACallAreBusyForEveryFunctionFromCallbackAndThread) {
  const auto callback = [](const brs_progress*, void* user) -> std::int32_t {
    auto& test = *static_cast<Handles*>(user);
    test.expect_all_busy();
    std::thread([&] { test.expect_all_busy(); }).join();
    return 0;
  };
  const auto log = [](brs_status, const char*, void* user) {
    static_cast<Handles*>(user)->expect_all_busy();
  };
  w.good(brs_context_set_progress(w.context, callback, this));
  w.good(brs_context_set_log(w.context, log, this));
  w.good(w.solve_after_loss(5000.0));
  World undisturbed;
  undisturbed.good(undisturbed.solve_after_loss(5000.0));
  w.good(brs_context_set_log(w.context, nullptr, nullptr));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), undisturbed.field(BRS_FIELD_DISPLACEMENT));
}

TEST_F(Handles, EveryFunctionOfTheHeaderIsProbed) {
  std::ifstream file(BRAINSHIFT_C_HEADER);
  std::stringstream header;
  header << file.rdbuf();
  const std::string text = header.str();
  std::set<std::string> declared, probed{"brs_context_create", "brs_context_message"};
  const std::regex function("BRS_API[^;(]*(brs_[a-z_]+)\\(([^;]*)\\);");
  for (std::sregex_iterator i(text.begin(), text.end(), function), end; i != end; ++i) {
    const std::string name = (*i)[1], arguments = (*i)[2];
    const bool has_handle = std::regex_search(
        arguments, std::regex("brs_(context|mesh|surface|scene|device|stepper|snapshot)\\*"));
    if (has_handle) declared.insert(name);
  }
  for (const Probe& p : all()) probed.insert(p.function);
  for (const Probe& p : probes_of_destroy()) probed.insert(p.function);
  EXPECT_GT(declared.size(), 60u);
  EXPECT_EQ(declared, probed);
}

}  // namespace
}  // namespace brainshift::test
