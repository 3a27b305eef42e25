// Version of the headers; the build fails where it differs from CMakeLists.txt.
#pragma once

#define BRAINSHIFT_VERSION_MAJOR 0
#define BRAINSHIFT_VERSION_MINOR 1
#define BRAINSHIFT_VERSION_PATCH 0
#define BRAINSHIFT_VERSION "0.1.0"

// Comparable in one piece: BRAINSHIFT_VERSION_NUMBER >= 10203 means at least 1.2.3.
#define BRAINSHIFT_VERSION_NUMBER \
  (BRAINSHIFT_VERSION_MAJOR * 10000 + BRAINSHIFT_VERSION_MINOR * 100 + BRAINSHIFT_VERSION_PATCH)
