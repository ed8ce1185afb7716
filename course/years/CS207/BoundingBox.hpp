#pragma once
/** @file BoundingBox.hpp
 * CME212/BoundingBox.hpp by its name in years whose folder and namespace are
 * CS207. */
#include "CME212/BoundingBox.hpp"

namespace CME212 {}
namespace CS207 = CME212;
