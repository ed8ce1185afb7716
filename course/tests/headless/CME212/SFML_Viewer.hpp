#pragma once
/** @file SFML_Viewer.hpp
 * The viewer by the name that later years of the course give it. */
#include "CME212/SDLViewer.hpp"

namespace CME212 {

using SFML_Viewer = SDLViewer;

}  // namespace CME212
