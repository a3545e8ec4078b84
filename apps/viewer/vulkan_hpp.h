#pragma once

// The viewer configures Vulkan-Hpp here only.
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <vulkan/vulkan_raii.hpp>
