// Version, status names, context.
#include <new>

#include "build_info.hpp"
#include "guard.hpp"

#define BRS_TEXT_OF(number) #number
#define BRS_TEXT(number) BRS_TEXT_OF(number)

using namespace brainshift::capi;

int32_t brs_version(void) { return BRS_VERSION; }

const char* brs_version_string(void) {
  return BRS_TEXT(BRS_VERSION_MAJOR) "." BRS_TEXT(BRS_VERSION_MINOR) "." BRS_TEXT(
      BRS_VERSION_PATCH);
}

const char* brs_build_info(void) { return BRAINSHIFT_BUILD_INFO; }

const char* brs_status_name(brs_status status) {
#define BRS_NAME(name) \
  case name: return #name
  switch (status) {
    BRS_NAME(BRS_OK);
    BRS_NAME(BRS_NOT_CONVERGED);
    BRS_NAME(BRS_NO_EQUILIBRIUM);
    BRS_NAME(BRS_CANCELLED);
    BRS_NAME(BRS_OUTSIDE);
    BRS_NAME(BRS_INFEASIBLE);
    BRS_NAME(BRS_ERROR_NULL);
    BRS_NAME(BRS_ERROR_HANDLE);
    BRS_NAME(BRS_ERROR_SIZE);
    BRS_NAME(BRS_ERROR_STRUCT_SIZE);
    BRS_NAME(BRS_ERROR_BUSY);
    BRS_NAME(BRS_ERROR_MEMORY);
    BRS_NAME(BRS_ERROR_VERSION);
    BRS_NAME(BRS_ERROR_CALLBACK);
    BRS_NAME(BRS_ERROR_INTERNAL);
    BRS_NAME(BRS_ERROR_INVALID_ARGUMENT);
    BRS_NAME(BRS_ERROR_EMPTY);
    BRS_NAME(BRS_ERROR_SIZE_MISMATCH);
    BRS_NAME(BRS_ERROR_INDEX_OUT_OF_RANGE);
    BRS_NAME(BRS_ERROR_NOT_FINITE);
    BRS_NAME(BRS_ERROR_INVERTED_ELEMENT);
    BRS_NAME(BRS_ERROR_DEGENERATE_ELEMENT);
    BRS_NAME(BRS_ERROR_DUPLICATE_ELEMENT);
    BRS_NAME(BRS_ERROR_ORPHAN_NODE);
    BRS_NAME(BRS_ERROR_SURFACE_NOT_CLOSED);
    BRS_NAME(BRS_ERROR_INITIAL_PENETRATION);
    BRS_NAME(BRS_ERROR_CONFLICTING_CONSTRAINTS);
    BRS_NAME(BRS_ERROR_RIGID_MODE);
    BRS_NAME(BRS_ERROR_FLUID_VOLUME);
    BRS_NAME(BRS_ERROR_LINEAR_SOLVER);
    BRS_NAME(BRS_ERROR_FILE);
  }
#undef BRS_NAME
  return "unknown status";
}

brs_status brs_context_create(int32_t header_version, brs_context** context) {
  if (!context) return BRS_ERROR_NULL;
  *context = nullptr;
  // Before 1.0 a minor version may change anything: the same rule as the soname.
  const int32_t series = BRS_VERSION_MAJOR == 0 ? 1000 : 1000000;
  if (header_version / series != BRS_VERSION / series || header_version > BRS_VERSION)
    return BRS_ERROR_VERSION;
  try {
    *context = new brs_context(std::make_shared<Context>());
    return BRS_OK;
  } catch (...) {
    return BRS_ERROR_MEMORY;
  }
}

brs_status brs_context_destroy(brs_context* context) { return destroy(context); }

const char* brs_context_message(const brs_context* context) {
  const Handle* base = context;
  if (!base) return "the context is NULL";
  if (base->magic != handle_magic || base->kind != Kind::context)
    return "what is given as a context is none";
  return base->context->message;
}

brs_status brs_context_set_progress(brs_context* context, brs_progress_fn progress, void* user) {
  return guard(context, [&](brs_context& c) {
    c.context->progress = progress;
    c.context->user = user;
  });
}

brs_status brs_context_set_log(brs_context* context, brs_log_fn log, void* user) {
  return guard(context, [&](brs_context& c) {
    c.context->log = log;
    c.context->log_user = user;
  });
}

brs_status brs_context_set_threads(brs_context* context, int32_t threads) {
  return guard(context, [&](brs_context& c) {
    if (threads < 1)
      throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                    "the number of threads is " + std::to_string(threads) + ", not 1 or more");
    c.context->threads = threads;
  });
}

brs_status brs_context_set_cancel(brs_context* context, int32_t cancel) {
  const Handle* base = context;
  if (!base) return BRS_ERROR_NULL;
  if (base->magic != handle_magic || base->kind != Kind::context) return BRS_ERROR_HANDLE;
  base->context->cancel = cancel != 0;
  return BRS_OK;
}
