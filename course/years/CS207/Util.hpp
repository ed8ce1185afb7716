#pragma once
/** @file Util.hpp
 * CME212/Util.hpp by its name in years whose folder and namespace are CS207. */
#include "CME212/Util.hpp"

namespace CME212 {}
namespace CS207 = CME212;
