#include "lab/run/Terminal.hpp"

#include <sstream>
#include <utility>

namespace lab {

namespace {

/** @a word, quoted as a shell needs it. */
std::string in_shell(const std::string& word) {
  constexpr const char* safe =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
      "_./=:,@%+-";
  if (!word.empty() && word.find_first_not_of(safe) == word.npos) return word;
  std::string text = "'";
  for (char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

/** The words of @a line. In a command blanks in quotes of in_shell() part none,
 * and an option stays with what follows it. */
std::vector<std::string> words_of(const std::string& line, bool command) {
  std::vector<std::string> words;
  bool inside = false, quoted = false, escaped = false;
  for (char c : line) {
    if (c == ' ' && !quoted && !escaped) {
      inside = false;
      continue;
    }
    if (!std::exchange(inside, true)) {
      const bool is_value = command && c != '-' && !words.empty() &&
                            words.back().starts_with("--") &&
                            words.back().find(' ') == std::string::npos;
      if (is_value)
        words.back() += ' ';
      else
        words.emplace_back();
    }
    words.back() += c;
    if (command && c == '\'' && !escaped) quoted = !quoted;
    escaped = command && c == '\\' && !quoted && !escaped;
  }
  return words;
}

/** Words in lines: the first one after @a head, others after @a next; @a tail
 * ends all but the last. */
std::vector<std::string> filled(const std::vector<std::string>& words,
                                std::size_t width, const std::string& head,
                                const std::string& next,
                                const std::string& tail) {
  std::vector<std::string> lines = {head};
  bool begins = true;
  for (const std::string& word : words) {
    const std::size_t tail_here = &word == &words.back() ? 0 : tail.size();
    if (!begins && lines.back().size() + 1 + word.size() + tail_here > width) {
      lines.back() += tail;
      lines.push_back(next);
      begins = true;
    }
    lines.back() += (begins ? "" : " ") + word;
    begins = false;
  }
  return lines;
}

}  // namespace

std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  return filled(words_of(text, false), width, "", "", "");
}

void say(std::ostream& out, std::string_view text) {
  constexpr std::size_t width = 80;
  std::istringstream in{std::string(text)};
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> parts = {line};
    if (line.size() > width) {
      const std::string indent = line.substr(0, line.find_first_not_of(' '));
      const bool command = indent.size() == 4;
      parts = filled(words_of(line, command), width, indent, indent + "  ",
                     command ? " \\" : "");
    }
    for (const std::string& part : parts) out << part << '\n';
  }
  out << std::flush;
}

std::string command_with(const std::vector<std::string>& words,
                         const std::string& cure) {
  std::string command = "   ";
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string name = words[k].substr(0, words[k].find('='));
    const bool replaced = (name == "--dt" || name == "--method") &&
                          cure.find(name + ' ') != cure.npos;
    if (!replaced)
      command += ' ' + in_shell(words[k]);
    else if (name == words[k])
      ++k;  // its value
  }
  return command + ' ' + cure;
}

}  // namespace lab
