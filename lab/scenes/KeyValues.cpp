#include "lab/scenes/KeyValues.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "CME212/Mesh.hpp"
#include "CME212/Util.hpp"

#define TOML_EXCEPTIONS 0  // WebAssembly has none
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

namespace lab {
namespace {

/** Reads the text of one file. */
class Reader {
 public:
  Reader(std::string_view text, const std::string& file)
      : text_(text), file_(file) {}

  void read(const std::function<void(const KeyValue&, std::size_t)>& use) {
    check_can_be_parsed();
    const auto result = toml::parse(text_);
    if (!result) fail(result.error());
    std::vector<decltype(result.begin())> keys;
    for (auto it = result.begin(); it != result.end(); ++it) keys.push_back(it);
    std::ranges::sort(keys, {}, [](auto it) {
      const auto& at = it->first.source().begin;
      return std::pair(at.line, at.column);
    });
    for (auto it : keys) {
      KeyValue found{std::string(it->first.str()), {}};
      line_ = it->first.source().begin.line;
      name_ = printable(found.key);
      if (const auto* list = it->second.as_array())
        for (const auto& value : *list) found.values.push_back(text_of(value));
      else
        found.values.push_back(text_of(it->second));
      use(found, line_);
    }
  }

 private:
  std::string_view text_;
  const std::string& file_;
  std::string name_;  // of the key that is read
  std::size_t line_ = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_, line_, what);
  }

  std::string text_of(const toml::node& value) const {
    if (const auto* text = value.as_string()) {
      if (text->get().find('\0') != std::string::npos)
        fail(name_ + " has the character 0, expected another text");
      return text->get();
    }
    if (const auto* whole = value.as_integer())
      return std::to_string(whole->get());
    if (const auto* number = value.as_floating_point())
      return CME212::exact_text(number->get());
    if (const auto* flag = value.as_boolean())
      return flag->get() ? "true" : "false";
    fail(name_ +
         (value.is_table()   ? " is a table"
          : value.is_array() ? " has a list in its list"
                             : " is a date or a time") +
         ", expected text, a number or a list of them");
  }

  /** Throws InputError: the text has a table, which no scene has, or a letter
   * out of quotes that no key has. Tables in tables would need too much stack,
   * and "[[[", "[}" or a letter with an accent end toml++ 3.3. */
  void check_can_be_parsed() {
    int dots = 0, lists = 0;
    bool begins = true;  // a line
    const auto fail_at = [&](std::size_t i, const char* what) {
      line_ = std::size_t(std::ranges::count(text_.substr(0, i), '\n')) + 1;
      fail(std::string("has a ") + what + ", expected KEY = VALUE");
    };
    const std::size_t bom = text_.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    for (std::size_t i = bom; i < text_.size(); ++i) {
      const auto c = static_cast<signed char>(text_[i]);
      if (c == '"' || c == '\'') {
        const std::string_view three = c == '"' ? "\"\"\"" : "'''";
        const auto end =
            text_.substr(i).starts_with(three) ? three : three.substr(2);
        i += end.size();
        while (i < text_.size() && !text_.substr(i).starts_with(end))
          i += c == '"' && text_[i] == '\\' ? 2 : 1;
        i += end.size() - 1;
      } else if (c == '#') {
        i = std::min(text_.find('\n', i), text_.size()) - 1;
      } else if (c == '{' || c == '}' || (c == '[' && begins && lists == 0) ||
                 (c == '.' && ++dots > 1000)) {
        fail_at(i, "table");
      } else if (c < 0) {
        fail_at(i, "letter out of quotes that is not ASCII");
      }
      lists += c == '[' ? 1 : c == ']' ? -1 : 0;
      begins = c == '\n' || (begins && (c == ' ' || c == '\t'));
    }
  }

  [[noreturn]] void fail(const toml::parse_error& error) {
    std::string what(error.description());
    line_ = std::max(error.source().begin.line, toml::source_index(1));
    std::size_t from = 0;  // of its line
    for (auto k = line_; k > 1 && from < text_.size(); --k)
      from = std::min(text_.find('\n', from), text_.size() - 1) + 1;
    const std::string_view begin = "Error while parsing ";
    if (what.starts_with(begin)) what.erase(0, begin.size());
    const auto line = text_.substr(from, text_.find('\n', from) - from);
    fail('"' + printable(line) + "\" is not TOML (" + printable(what) +
         "), expected KEY = VALUE, text in quotes");
  }
};

}  // namespace

void each_key_value(
    std::string_view text, const std::string& file,
    const std::function<void(const KeyValue&, std::size_t line)>& use) {
  Reader(text, file).read(use);
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

bool is_utf8(std::string_view text) {
  return bool(toml::parse("k = " + in_quotes(text)));
}

}  // namespace lab
