// Checks that a call fails with the right code and names the culprit.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "brainshift/error.hpp"

namespace brainshift::test {

// The message must hold every one of the `fragments`.
template <class Call>
void expect_error(ErrorCode code, std::initializer_list<std::string> fragments, Call&& call) {
  try {
    call();
    ADD_FAILURE() << "no error; expected " << to_string(code);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << to_string(error.code()) << ": " << error.what();
    for (const std::string& fragment : fragments)
      EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos)
          << "'" << fragment << "' is not in: " << error.what();
  }
}

}  // namespace brainshift::test
