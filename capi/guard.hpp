// Where exceptions stop: every function of the C face that takes a handle runs inside guard().
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "handle.hpp"

namespace brainshift::capi {

// Misuse of the interface, found by the wall itself.
class Refusal : public std::runtime_error {
 public:
  Refusal(brs_status status, const std::string& message)
      : std::runtime_error(message), m_status(status) {}
  brs_status status() const noexcept { return m_status; }

 private:
  brs_status m_status;
};

// One call into the context of a handle. Holds the context, whatever the call destroys.
class Call {
 public:
  explicit Call(const Handle* first) noexcept;
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  // Not BRS_OK: the call must end here with this status.
  brs_status status() const noexcept { return m_status; }
  // Status of the exception in flight; its message goes to the context.
  brs_status failed() noexcept;
  // Ends the call: the log hears what it had to say.
  brs_status ended(brs_status status) noexcept;

 private:
  std::shared_ptr<Context> m_context;
  brs_status m_status = BRS_OK;
};

// The handle, if it is one of this type; throws Refusal otherwise.
template <class T>
T& checked(T* handle) {
  const Kind expected = T::tag;
  if (!handle)
    throw Refusal(BRS_ERROR_NULL, std::string("the ") + to_string(expected) + " is NULL");
  const Handle* base = handle;
  if (base->magic != handle_magic)
    throw Refusal(BRS_ERROR_HANDLE,
                  std::string("what is given as a ") + to_string(expected) + " is no handle");
  if (base->kind != expected)
    throw Refusal(BRS_ERROR_HANDLE, std::string("a ") + to_string(base->kind) +
                                        " is given where a " + to_string(expected) +
                                        " is expected");
  return *handle;
}

// Runs body(handle); it returns nothing, or a status of its own.
template <class T, class Body>
brs_status guard(T* handle, Body&& body) noexcept {
  Call call(handle);
  if (call.status() != BRS_OK) return call.status();
  try {
    T& target = checked(handle);
    if constexpr (std::is_void_v<decltype(body(target))>) {
      body(target);
      return call.ended(BRS_OK);
    } else {
      return call.ended(body(target));
    }
  } catch (...) {
    return call.ended(call.failed());
  }
}

// Where a result goes: not NULL.
template <class T>
T& result(T* pointer, const char* what) {
  if (!pointer) throw Refusal(BRS_ERROR_NULL, std::string(what) + " is NULL");
  return *pointer;
}

// guard() for functions that make a handle: *made is NULL unless the body returns one.
template <class T, class Made, class Body>
brs_status create(T* handle, Made** made, const char* what, Body&& body) noexcept {
  if (made) *made = nullptr;
  return guard(handle, [&](T& target) {
    Made*& place = result(made, what);  // before the body makes what would then be lost
    place = body(target);
  });
}

template <class T>
brs_status destroy(T* handle) noexcept {
  if (!handle) return BRS_OK;
  return guard(handle, [](T& target) { delete &target; });
}

// Immutable values go at any time, from a callback or another thread too.
template <class T>
brs_status destroy_immutable(T* handle) noexcept {
  const Handle* base = handle;
  if (!base || base->magic != handle_magic || base->kind != T::tag) return destroy(handle);
  delete handle;
  return BRS_OK;
}

}  // namespace brainshift::capi
