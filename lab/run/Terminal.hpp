#pragma once
/** @file Terminal.hpp
 * Texts in lines that fit a terminal, and commands to paste. */
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/** @a text in lines of at most @a width characters, where words allow.
 * @return at least one line */
std::vector<std::string> wrapped(const std::string& text, std::size_t width);

/** Print what a run says, the lines of @a text, in 80 columns. A line is broken
 * between words; what follows is indented by two more. One that begins with
 * four spaces is a command: it can still be pasted, as a backslash ends each
 * part of it. Only a word may be longer. */
void say(std::ostream& out, std::string_view text);

/** The command line @a words with the options @a cure instead of its own: a
 * command for say(). */
std::string command_with(const std::vector<std::string>& words,
                         const std::string& cure);

}  // namespace lab
