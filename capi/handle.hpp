// What the opaque handles of the C face hold.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "brainshift/brainshift.hpp"
#include "brainshift/c/brainshift.h"

namespace brainshift::capi {

// Shared by all handles made in it, so that they may be destroyed in any order.
struct Context {
  std::atomic<bool> busy{false};
  std::atomic<std::thread::id> owner{};  // the thread of the present call
  std::atomic<bool> cancel{false};
  brs_progress_fn progress = nullptr;
  void* user = nullptr;
  brs_log_fn log = nullptr;
  void* log_user = nullptr;
  int threads = 1;
  // Of fixed size: a message about lack of memory needs none.
  char message[1024] = "";
  char note[512] = "";  // for the log, of a call that has gone well

  void say(const char* text) noexcept;  // cuts at the end of a UTF-8 character
};

enum class Kind : std::uint32_t { context, mesh, surface, scene, device, stepper, snapshot };

const char* to_string(Kind kind);

constexpr std::uint32_t handle_magic = 0x73726221;  // "!brs"

// Base of every handle. No virtual functions: the tag must be readable through a pointer that
// the caller cast from another handle type.
struct Handle {
  std::uint32_t magic = handle_magic;
  Kind kind;
  std::shared_ptr<Context> context;

  Handle(Kind k, std::shared_ptr<Context> c) : kind(k), context(std::move(c)) {}
};

template <Kind K>
struct TaggedHandle : Handle {
  static constexpr Kind tag = K;
  explicit TaggedHandle(std::shared_ptr<Context> c) : Handle(K, std::move(c)) {}
};

// A Csf is complete when it is made; a scene in C gets its compartments one by one.
struct CsfPlan {
  double density;
  FluidModel model;
  double reference_head;
};

}  // namespace brainshift::capi

struct brs_context : brainshift::capi::TaggedHandle<brainshift::capi::Kind::context> {
  using TaggedHandle::TaggedHandle;
};

struct brs_mesh : brainshift::capi::TaggedHandle<brainshift::capi::Kind::mesh> {
  brs_mesh(std::shared_ptr<brainshift::capi::Context> c, brainshift::Mesh mesh)
      : TaggedHandle(std::move(c)), value(std::move(mesh)) {}
  const brainshift::Mesh value;
};

struct brs_surface : brainshift::capi::TaggedHandle<brainshift::capi::Kind::surface> {
  brs_surface(std::shared_ptr<brainshift::capi::Context> c, brainshift::Surface surface)
      : TaggedHandle(std::move(c)), value(std::move(surface)) {}
  const brainshift::Surface value;
};

struct brs_scene : brainshift::capi::TaggedHandle<brainshift::capi::Kind::scene> {
  brs_scene(std::shared_ptr<brainshift::capi::Context> c, const brainshift::Mesh& mesh)
      : TaggedHandle(std::move(c)), value{mesh, {}} {}
  brainshift::Scene value;  // its csf stays empty until a stepper is made
  std::optional<brainshift::capi::CsfPlan> csf;
  std::vector<brainshift::Compartment> compartments;
};

struct brs_device : brainshift::capi::TaggedHandle<brainshift::capi::Kind::device> {
  brs_device(std::shared_ptr<brainshift::capi::Context> c, brainshift::BeamDevice device)
      : TaggedHandle(std::move(c)), value(std::move(device)) {}
  const brainshift::BeamDevice value;
};

struct brs_stepper : brainshift::capi::TaggedHandle<brainshift::capi::Kind::stepper> {
  brs_stepper(std::shared_ptr<brainshift::capi::Context> c, brainshift::Stepper stepper)
      : TaggedHandle(std::move(c)), value(std::move(stepper)) {}
  brainshift::Stepper value;
  // What views point to, where the stepper computes a value on demand.
  std::array<brainshift::Points, 8> vectors;
  std::array<Eigen::VectorXd, 8> scalars;
  std::map<brainshift::ConstraintId, brainshift::ContactState> contacts;
  std::map<brainshift::DeviceId, brainshift::DeviceState> devices;
};

struct brs_snapshot : brainshift::capi::TaggedHandle<brainshift::capi::Kind::snapshot> {
  using Value = std::shared_ptr<const brainshift::Stepper::Snapshot>;
  brs_snapshot(std::shared_ptr<brainshift::capi::Context> c, Value snapshot)
      : TaggedHandle(std::move(c)), value(std::move(snapshot)) {}
  const Value value;
};
