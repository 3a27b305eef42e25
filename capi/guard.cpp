#include "guard.hpp"

#include <cstring>
#include <new>

namespace brainshift::capi {
namespace {

brs_status status_of(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::invalid_argument: return BRS_ERROR_INVALID_ARGUMENT;
    case ErrorCode::empty: return BRS_ERROR_EMPTY;
    case ErrorCode::size_mismatch: return BRS_ERROR_SIZE_MISMATCH;
    case ErrorCode::index_out_of_range: return BRS_ERROR_INDEX_OUT_OF_RANGE;
    case ErrorCode::not_finite: return BRS_ERROR_NOT_FINITE;
    case ErrorCode::inverted_element: return BRS_ERROR_INVERTED_ELEMENT;
    case ErrorCode::degenerate_element: return BRS_ERROR_DEGENERATE_ELEMENT;
    case ErrorCode::duplicate_element: return BRS_ERROR_DUPLICATE_ELEMENT;
    case ErrorCode::orphan_node: return BRS_ERROR_ORPHAN_NODE;
    case ErrorCode::surface_not_closed: return BRS_ERROR_SURFACE_NOT_CLOSED;
    case ErrorCode::initial_penetration: return BRS_ERROR_INITIAL_PENETRATION;
    case ErrorCode::conflicting_constraints: return BRS_ERROR_CONFLICTING_CONSTRAINTS;
    case ErrorCode::rigid_mode: return BRS_ERROR_RIGID_MODE;
    case ErrorCode::fluid_volume: return BRS_ERROR_FLUID_VOLUME;
    case ErrorCode::linear_solver: return BRS_ERROR_LINEAR_SOLVER;
    case ErrorCode::file: return BRS_ERROR_FILE;
    case ErrorCode::internal: return BRS_ERROR_INTERNAL;
  }
  return BRS_ERROR_INTERNAL;
}

}  // namespace

void Context::say(const char* text) noexcept {
  std::size_t length = std::strlen(text);
  if (length >= sizeof message) {
    length = sizeof message - 1;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
  }
  std::memcpy(message, text, length);
  message[length] = '\0';
}

const char* to_string(Kind kind) {
  switch (kind) {
    case Kind::context: return "context";
    case Kind::mesh: return "mesh";
    case Kind::surface: return "surface";
    case Kind::scene: return "scene";
    case Kind::device: return "device";
    case Kind::stepper: return "stepper";
    case Kind::snapshot: return "snapshot";
  }
  return "handle";
}

Call::Call(const Handle* first) noexcept {
  if (!first || first->magic != handle_magic) {
    m_status = first ? BRS_ERROR_HANDLE : BRS_ERROR_NULL;
    return;
  }
  Context& context = *first->context;
  if (context.busy.exchange(true, std::memory_order_acquire)) {
    m_status = BRS_ERROR_BUSY;
    // Only this thread's own message: another thread may be writing one.
    if (context.owner.load() == std::this_thread::get_id()) {
      context.say("the context is in a call, and a callback made another one into it");
    }
    return;
  }
  m_context = first->context;
  context.owner = std::this_thread::get_id();
  context.say("");
  context.note[0] = '\0';
}

Call::~Call() {
  if (!m_context) return;
  m_context->owner = std::thread::id();
  m_context->busy.store(false, std::memory_order_release);
}

// Busy as it still is, the context refuses what the log may try to do with it.
brs_status Call::ended(brs_status status) noexcept {
  Context& context = *m_context;
  const char* said = context.message[0] ? context.message : context.note;
  if (!context.log || !said[0]) return status;
  char kept[sizeof context.message];
  std::memcpy(kept, context.message, sizeof kept);
  try {
    context.log(status, said, context.log_user);
  } catch (...) {  // as the header says: the call has done what it has done
  }
  std::memcpy(context.message, kept, sizeof kept);
  return status;
}

brs_status Call::failed() noexcept {
  try {
    throw;
  } catch (const Refusal& refusal) {
    m_context->say(refusal.what());
    return refusal.status();
  } catch (const Error& error) {
    m_context->say(error.what());
    return status_of(error.code());
  } catch (const std::bad_alloc&) {
    m_context->say("there is not enough memory");
    return BRS_ERROR_MEMORY;
  } catch (const std::exception& error) {
    m_context->say(error.what());
    return BRS_ERROR_INTERNAL;
  } catch (...) {
    m_context->say("an unknown exception was thrown");
    return BRS_ERROR_INTERNAL;
  }
}

}  // namespace brainshift::capi
