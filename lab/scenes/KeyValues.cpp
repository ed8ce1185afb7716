#include "lab/scenes/KeyValues.hpp"

#include <cctype>
#include <charconv>
#include <stdexcept>

#include "CME212/Mesh.hpp"

namespace lab {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::string_view blanks = " \t\r";
constexpr const char* not_closed = "has a value that is not closed on its line";

/** Append the code point @a c in UTF-8. */
void append_utf8(std::string& text, unsigned c) {
  if (c < 0x80) {
    text += char(c);
    return;
  }
  const int more = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
  text += char((0xFF00 >> (more + 1) & 0xFF) | c >> 6 * more);
  for (int k = more - 1; k >= 0; --k) text += char(0x80 | (c >> 6 * k & 0x3F));
}

/** Reads the values of one line from its front. what() of its errors continues
 * a sentence that begins with the key. */
class Reader {
 public:
  explicit Reader(std::string_view rest) : rest_(rest) {}

  std::vector<std::string> values() {
    std::vector<std::string> all;
    if (at_end()) fail("has no value");
    if (!take('[')) {
      all.push_back(value("#"));
    } else {
      while (!take(']')) {
        if (at_end()) fail(not_closed);
        all.push_back(value(",]#"));
        if (!take(',') && !ahead(']')) fail(not_closed);
      }
    }
    if (ahead('"') || ahead(']') || ahead('[')) fail(not_closed);
    if (!at_end()) fail("has text after its value");
    return all;
  }

 private:
  std::string_view rest_;

  [[noreturn]] static void fail(const std::string& what) {
    throw std::runtime_error(what);
  }
  void skip_blanks() {
    rest_.remove_prefix(
        std::min(rest_.find_first_not_of(blanks), rest_.size()));
  }
  bool ahead(char c) {
    skip_blanks();
    return rest_.starts_with(c);
  }
  bool at_end() { return ahead('#') || rest_.empty(); }
  bool take(char c) {
    if (!ahead(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  /** The next @a n characters. */
  std::string_view next(std::size_t n) {
    if (rest_.size() < n) fail(not_closed);
    const auto taken = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return taken;
  }

  /** One value; if it has no quotes, up to one of the characters @a stops. */
  std::string value(const char* stops) {
    if (take('"')) return escaped();
    if (take('\'')) {
      const auto end = rest_.find('\'');
      if (end == std::string_view::npos) fail(not_closed);
      const std::string text(next(end));
      next(1);
      return text;
    }
    const auto bare = next(std::min(rest_.find_first_of(stops), rest_.size()));
    if (bare.find_first_of("\"[]") != std::string_view::npos) fail(not_closed);
    const auto last = bare.find_last_not_of(blanks);
    if (last == std::string_view::npos) fail("has an empty item in its list");
    return std::string(bare.substr(0, last + 1));
  }

  std::string escaped() {
    std::string text;
    while (true) {
      const char c = next(1)[0];
      if (c == '"') return text;
      if (c != '\\') {
        text += c;
        continue;
      }
      const char code = next(1)[0];
      constexpr std::string_view codes = "\"\\btnfr", meant = "\"\\\b\t\n\f\r";
      if (const auto k = codes.find(code); k != std::string_view::npos) {
        text += meant[k];
        continue;
      }
      unsigned point = 0;
      if (code == 'u' || code == 'U') {
        const auto hex = next(code == 'u' ? 4 : 8);
        const auto [end, error] =
            std::from_chars(hex.data(), hex.data() + hex.size(), point, 16);
        if (error == std::errc() && end == hex.data() + hex.size() &&
            point < 0x110000 && (point < 0xD800 || point > 0xDFFF) &&
            point != 0) {
          append_utf8(text, point);
          continue;
        }
      }
      fail("has \\" + printable({&code, 1}) +
           " in its text, which is not a valid escape: write \\ as \\\\");
    }
  }
};

}  // namespace

void each_key_value(
    std::string_view text, const std::string& file,
    const std::function<void(const KeyValue&, std::size_t line)>& use) {
  if (text.starts_with(byte_order_mark))
    text.remove_prefix(byte_order_mark.size());
  for (std::size_t number = 1; !text.empty(); ++number) {
    const auto end = std::min(text.find('\n'), text.size());
    const auto line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const auto first = line.find_first_not_of(blanks);
    if (first == std::string_view::npos || line[first] == '#') continue;
    const auto equals = line.find('=');
    if (equals == std::string_view::npos || equals == first) {
      const auto whole = line.substr(0, line.find_last_not_of('\r') + 1);
      throw InputError(file, number,
                       '"' + printable(whole) + "\", expected KEY = VALUE");
    }
    const auto last = line.find_last_not_of(blanks, equals - 1);
    KeyValue found{std::string(line.substr(first, last - first + 1)), {}};
    try {
      found.values = Reader(line.substr(equals + 1)).values();
    } catch (const std::runtime_error& e) {
      throw InputError(file, number, printable(found.key) + ' ' + e.what());
    }
    use(found, number);
  }
}

std::string printable(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string shown(text.substr(0, longest));
  for (char& c : shown)
    if (std::iscntrl(static_cast<unsigned char>(c))) c = '?';
  return shown + (text.size() > longest ? "..." : "");
}

std::string in_quotes(std::string_view text) {
  constexpr char hex[] = "0123456789ABCDEF";
  std::string quoted = "\"";
  for (unsigned char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (c >= 0x20 && c != 0x7F)
      quoted += char(c);
    else
      quoted += std::string("\\u00") + hex[c >> 4] + hex[c & 15];
  }
  return quoted + '"';
}

}  // namespace lab
