#pragma once

// The one place of the viewer that configures Vulkan-Hpp.
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <vulkan/vulkan_raii.hpp>
