#include "stepper/bytes.hpp"

namespace brainshift {
namespace {

constexpr char magic[9] = "BRNSHIFT";
constexpr std::size_t head_size = 8 + 3 * 8, seal_size = 8;

}  // namespace

std::uint64_t checksum(const std::uint8_t* bytes, std::size_t count) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
  return hash;
}

Bytes ByteWriter::sealed(BytesKind kind) const {
  ByteWriter envelope;
  envelope.m_bytes.assign(magic, magic + 8);
  envelope.put(kind);
  envelope.put(bytes_version);
  envelope.put(m_bytes.size());
  envelope.m_bytes.insert(envelope.m_bytes.end(), m_bytes.begin(), m_bytes.end());
  envelope.put(checksum(envelope.m_bytes.data(), envelope.m_bytes.size()));
  return std::move(envelope.m_bytes);
}

ByteReader::ByteReader(const Bytes& sealed, BytesKind kind)
    : m_at(sealed.data()), m_end(sealed.data() + sealed.size()) {
  if (sealed.size() < head_size + seal_size || std::memcmp(sealed.data(), magic, 8) != 0) {
    fail("they do not begin as a snapshot or a recording does");
  }
  m_at += 8;
  const std::uint64_t found_kind = word(), version = word(), length = word();
  if (version != bytes_version) {
    fail("they are of version " + std::to_string(version) + " of the format, and this is version " +
         std::to_string(bytes_version));
  }
  if (length != sealed.size() - head_size - seal_size) {
    fail("they should hold " + std::to_string(length) + " bytes of content, and hold " +
         std::to_string(sealed.size() - head_size - seal_size));
  }
  m_at += length;
  if (word() != checksum(sealed.data(), sealed.size() - seal_size)) {
    fail("their checksum is wrong");
  }
  if (found_kind != std::uint64_t(kind)) {
    fail(kind == BytesKind::snapshot ? "they are no snapshot" : "they are no recording");
  }
  m_at = sealed.data() + head_size;
  m_end = m_at + length;
}

std::size_t ByteReader::count(std::size_t size) {
  const std::uint64_t number = word();
  if (number > std::size_t(m_end - m_at) / size) fail("a list is longer than they are");
  return std::size_t(number);
}

void ByteReader::expect_end() const {
  if (m_at != m_end) fail("something follows their end");
}

void ByteReader::fail(const std::string& what) {
  throw Error(ErrorCode::file, "the bytes cannot be read: " + what);
}

std::uint64_t ByteReader::word() {
  const std::uint8_t* bytes = take(8);
  std::uint64_t bits = 0;
  for (int i = 0; i < 8; ++i) bits |= std::uint64_t(bytes[i]) << 8 * i;
  return bits;
}

const std::uint8_t* ByteReader::take(std::size_t size) {
  if (size > std::size_t(m_end - m_at)) fail("they end too early");
  const std::uint8_t* here = m_at;
  m_at += size;
  return here;
}

}  // namespace brainshift
