#pragma once
/** @file BoundingBox.hpp
 * CME212/BoundingBox.hpp by its name in years that have it in the root. */
#include "CME212/BoundingBox.hpp"
