/** @file Png.cpp
 * PNG files (RFC 2083): a picture, compressed with the fixed Huffman codes of
 * RFC 1951. */
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "CME212/OutputFile.hpp"
#include "CME212/viewer/Image.hpp"

namespace CME212 {

namespace {

/** @a value as four bytes, the highest first. */
std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift : {24, 16, 8, 0}) bytes += char(value >> shift);
  return bytes;
}

std::uint32_t crc32(std::string_view data) {
  std::uint32_t sum = ~0u;
  for (unsigned char c : data) {
    sum ^= c;
    for (int k = 0; k < 8; ++k) sum = sum >> 1 ^ (sum & 1 ? 0xedb88320u : 0);
  }
  return ~sum;
}

/** Compresses data: bytes that came before are replaced by their distance. */
class Deflate {
 public:
  /** @return a zlib stream (RFC 1950) of @a data */
  std::string operator()(std::string_view data) {
    out_ = "\x78\x01";
    put(3, 3);  // the last block, with fixed codes
    std::vector<std::size_t> last(1 << 15, data.size());  // place of a hash
    for (std::size_t at = 0; at < data.size();) {
      std::size_t length = 0, before = data.size();
      if (at + 3 <= data.size()) {
        const auto byte = [&](int k) { return std::uint8_t(data[at + k]); };
        const auto hash =
            (byte(0) | byte(1) << 8 | byte(2) << 16) * 2654435761u;
        before = std::exchange(last[hash >> 17], at);
        if (before < at && at - before <= 32768)
          while (length < 258 && at + length < data.size() &&
                 data[before + length] == data[at + length])
            ++length;
      }
      if (length >= 3)
        put_match(unsigned(length), unsigned(at - before));
      else
        put_symbol(std::uint8_t(data[at])), length = 1;
      at += length;
    }
    put_symbol(256);  // the end
    put(0, 7);
    std::uint32_t a = 1, b = 0;
    for (unsigned char c : data) a = (a + c) % 65521, b = (b + a) % 65521;
    return out_ + big_endian(b << 16 | a);
  }

 private:
  std::string out_;
  std::uint32_t bits_ = 0;
  int count_ = 0;  // of bits_

  void put(std::uint32_t value, int count) {
    bits_ |= value << count_;
    for (count_ += count; count_ >= 8; count_ -= 8, bits_ >>= 8)
      out_ += char(bits_);
  }
  /** A code: its highest bit first. */
  void put_code(unsigned code, int count) {
    while (--count >= 0) put(code >> count & 1, 1);
  }
  void put_symbol(unsigned s) {
    if (s < 144) return put_code(0x30 + s, 8);
    if (s < 256) return put_code(0x190 + s - 144, 9);
    if (s < 280) return put_code(s - 256, 7);
    put_code(0xc0 + s - 280, 8);
  }
  void put_match(unsigned length, unsigned distance) {
    const auto extra = [](unsigned a, int free) {
      return std::max(0, int(std::bit_width(a)) - free);
    };
    const unsigned l = length - 3, d = distance - 1;
    const int e = extra(l, 3), f = extra(d, 2);
    if (length == 258)
      put_symbol(285);
    else
      put_symbol(257 + 4 * e + (l >> e)), put(l & ((1u << e) - 1), e);
    put_code(2 * f + (d >> f), 5), put(d & ((1u << f) - 1), f);
  }
};

/** Each row after the number of its filter, 4: the difference of each byte
 * from the nearest to left + up - corner (Paeth). */
std::string filtered(const Image& image) {
  std::string rows;
  const int bytes = 3 * image.width;
  for (int y = 0; y < image.height; ++y) {
    rows += '\4';
    const std::uint8_t* row = image.pixel(0, y);
    for (int k = 0; k < bytes; ++k) {
      const int left = k < 3 ? 0 : row[k - 3], up = y == 0 ? 0 : row[k - bytes];
      const int corner = k < 3 || y == 0 ? 0 : row[k - bytes - 3];
      const int guess = left + up - corner, to_left = std::abs(guess - left),
                to_up = std::abs(guess - up),
                to_corner = std::abs(guess - corner);
      rows += char(row[k] - (to_left <= to_up && to_left <= to_corner ? left
                             : to_up <= to_corner                     ? up
                                                  : corner));
    }
  }
  return rows;
}

}  // namespace

void write_png(const std::string& path, const Image& image) {
  if (image.rgb.empty())
    throw std::runtime_error(path + ": a picture without pixels");
  OutputFile file(path);
  const auto chunk = [&](std::string data) {
    file.stream() << big_endian(std::uint32_t(data.size() - 4)) << data
                  << big_endian(crc32(data));
  };
  file.stream() << "\x89PNG\r\n\x1a\n";
  using namespace std::literals;
  chunk("IHDR" + big_endian(std::uint32_t(image.width)) +
        big_endian(std::uint32_t(image.height)) + "\x8\x2\0\0\0"s);  // RGB
  chunk("IDAT" + Deflate()(filtered(image)));
  chunk("IEND");
  file.commit();
}

}  // namespace CME212
