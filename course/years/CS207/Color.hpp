#pragma once
/** @file Color.hpp
 * CME212/Color.hpp by its name in years whose folder and namespace are CS207.
 */
#include "CME212/Color.hpp"

namespace CME212 {}
namespace CS207 = CME212;
