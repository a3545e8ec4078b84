#pragma once

#include "viewer/document.h"

#include <string>

namespace pellucid::viewer {

// Sections of the panel. Each changes a part of the look.

void technique_section(Look& look, const Renderer& renderer);
void camera_section(Document& document);
void animation_section(Document& document, bool& playing, float& speed);
void material_section(Document& document);
void light_section(Document& document);
/// `path`: text of the file field; `wish` receives an environment to load.
void environment_section(Document& document, std::string& path, std::string& wish);
void display_section(Look& look);

}  // namespace pellucid::viewer
