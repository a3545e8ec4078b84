#pragma once

// The only file that configures Vulkan-Hpp.
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <vulkan/vulkan_raii.hpp>
