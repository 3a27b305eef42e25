// Snapshots and recordings as bytes, through the C face.
#include "world.hpp"

namespace brainshift::test {
namespace {

using Buffer = std::vector<std::uint8_t>;

template <class Handle>
Buffer bytes_of(const World& w, Handle* handle,
                brs_status (*write)(Handle*, std::uint8_t*, std::int64_t, std::int64_t*)) {
  std::int64_t count = 0;
  w.good(write(handle, nullptr, 0, &count));
  Buffer bytes(std::size_t(count), 0);
  w.good(write(handle, bytes.data(), count, &count));
  EXPECT_EQ(std::size_t(count), bytes.size());
  return bytes;
}

TEST(Bytes, OfASnapshotComeBackAsTheSameState) {
  World w, other;
  w.good(w.solve_after_loss(5000.0));
  brs_snapshot* kept = nullptr;
  w.good(brs_stepper_snapshot(w.stepper, &kept));
  const Buffer bytes = bytes_of(w, kept, &brs_snapshot_bytes);
  brs_snapshot_destroy(kept);
  brs_snapshot* read = nullptr;
  other.good(
      brs_stepper_read_snapshot(other.stepper, bytes.data(), std::int64_t(bytes.size()), &read));
  other.good(brs_stepper_restore(other.stepper, read));
  EXPECT_EQ(other.field(BRS_FIELD_DISPLACEMENT), w.field(BRS_FIELD_DISPLACEMENT));
  EXPECT_EQ(other.field(BRS_FIELD_EXTERNAL_FORCE), w.field(BRS_FIELD_EXTERNAL_FORCE));
  EXPECT_EQ(bytes_of(other, read, &brs_snapshot_bytes), bytes);
  brs_snapshot_destroy(read);
}

TEST(Bytes, OfARecordingGoOnWithTheSameBitsInAnotherContext) {
  World w;
  w.good(w.solve_after_loss(5000.0));
  const Buffer bytes = bytes_of(w, w.stepper, &brs_stepper_record);
  brs_context* context = nullptr;
  brs_stepper* replayed = nullptr;
  w.good(brs_context_create(BRS_VERSION, &context));
  ASSERT_EQ(brs_stepper_replay(context, bytes.data(), std::int64_t(bytes.size()), &replayed),
            BRS_OK)
      << brs_context_message(context);
  w.good(w.solve_after_loss(9000.0));
  EXPECT_EQ(brs_stepper_set_csf(replayed, 0, BRS_CSF_LOST_VOLUME, 9000.0), BRS_OK);
  EXPECT_EQ(brs_stepper_solve_static(replayed, nullptr), BRS_OK);
  const double* u = nullptr;
  std::int64_t rows = 0;
  EXPECT_EQ(brs_stepper_field(replayed, BRS_FIELD_DISPLACEMENT, &u, &rows, nullptr), BRS_OK);
  EXPECT_EQ(std::vector<double>(u, u + 3 * rows), w.field(BRS_FIELD_DISPLACEMENT));
  brs_stepper_destroy(replayed);
  brs_context_destroy(context);
}

TEST(Bytes, ThatAreDamagedOrNoneAreRefused) {
  World w;
  Buffer bytes = bytes_of(w, w.snapshot, &brs_snapshot_bytes);
  const auto read = [&](const std::uint8_t* from, std::int64_t count) {
    brs_snapshot* made = w.snapshot;
    const brs_status status = brs_stepper_read_snapshot(w.stepper, from, count, &made);
    EXPECT_TRUE(status == BRS_OK || made == nullptr);
    if (status == BRS_OK) brs_snapshot_destroy(made);
    return status;
  };
  const auto size = std::int64_t(bytes.size());
  EXPECT_EQ(read(bytes.data(), size), BRS_OK);
  EXPECT_EQ(read(bytes.data(), size - 1), BRS_ERROR_FILE);
  EXPECT_EQ(read(bytes.data(), 0), BRS_ERROR_FILE);
  EXPECT_EQ(read(nullptr, 0), BRS_ERROR_FILE);
  EXPECT_EQ(read(nullptr, 9), BRS_ERROR_NULL);
  EXPECT_EQ(read(bytes.data(), -1), BRS_ERROR_SIZE);
  bytes[bytes.size() / 2] ^= 4;
  EXPECT_EQ(read(bytes.data(), size), BRS_ERROR_FILE);
  EXPECT_NE(w.message().find("checksum"), std::string::npos) << w.message();
  const Buffer recording = bytes_of(w, w.stepper, &brs_stepper_record);
  EXPECT_EQ(read(recording.data(), std::int64_t(recording.size())), BRS_ERROR_FILE);
  std::int64_t count = 0;
  EXPECT_EQ(brs_snapshot_bytes(w.snapshot, nullptr, 5, &count), BRS_ERROR_NULL);
  EXPECT_EQ(brs_snapshot_bytes(w.snapshot, bytes.data(), 5, nullptr), BRS_ERROR_NULL);
}

}  // namespace
}  // namespace brainshift::test
