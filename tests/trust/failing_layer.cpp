// A Vulkan layer in which calls fail as a driver's may: allocations for lack of memory, submissions and waits because
// the device is lost. PELLUCID_FAIL_ALLOCATIONS=N, PELLUCID_FAIL_OBJECTS=N and PELLUCID_LOSE_DEVICE=N choose the first
// call of the process that fails, from 1; later calls fail as well. Tests in the process use failing_layer.h.
#include "trust/failing_layer.h"

#include <vulkan/vk_layer.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string_view>

namespace {

using pellucid::test::Failures;

std::uint64_t from_environment(const char* name) {
    const char* text = std::getenv(name);
    return text == nullptr ? Failures::kNever : std::strtoull(text, nullptr, 10);
}

Failures failures{.first_allocation = from_environment("PELLUCID_FAIL_ALLOCATIONS"),
                  .first_object = from_environment("PELLUCID_FAIL_OBJECTS"),
                  .first_submission = from_environment("PELLUCID_LOSE_DEVICE")};

/// True if this call fails. The first failing call is the `first`-th.
bool fails(std::atomic<std::uint64_t>& count, const std::atomic<std::uint64_t>& first) { return ++count >= first; }

/// What this layer calls in turn, by the dispatch table that instances and devices start with.
struct Next {
    PFN_vkGetInstanceProcAddr instance = nullptr;
    PFN_vkGetDeviceProcAddr device = nullptr;
};
std::mutex mutex;
std::map<void*, Next> next_of;

void* key_of(void* handle) { return *static_cast<void**>(handle); }

Next next(void* handle) {
    const std::lock_guard lock(mutex);
    return next_of[key_of(handle)];
}

template <class Function>
Function next_call(VkDevice device, const char* name) {
    return reinterpret_cast<Function>(next(device).device(device, name));
}

template <class Info, class LinkInfo>
LinkInfo* link_info(const Info* info, VkStructureType type) {
    auto* each = static_cast<LinkInfo*>(const_cast<void*>(info->pNext));
    while (each != nullptr && !(each->sType == type && each->function == VK_LAYER_LINK_INFO))
        each = static_cast<LinkInfo*>(const_cast<void*>(each->pNext));
    return each;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* memory,
                                               VkInstance* instance) {
    auto* link =
        link_info<VkInstanceCreateInfo, VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    const PFN_vkGetInstanceProcAddr get = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(get(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, memory, instance);
    if (result != VK_SUCCESS) return result;
    const std::lock_guard lock(mutex);
    next_of[key_of(*instance)] = {get, nullptr};
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* memory, VkDevice* device) {
    auto* link =
        link_info<VkDeviceCreateInfo, VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    const PFN_vkGetInstanceProcAddr get = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr get_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(get(VK_NULL_HANDLE, "vkCreateDevice"));
    const VkResult result = create(physical, info, memory, device);
    if (result != VK_SUCCESS) return result;
    const std::lock_guard lock(mutex);
    next_of[key_of(*device)] = {get, get_device};
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info,
                                               const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory) {
    if (fails(failures.allocations, failures.first_allocation)) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    ++failures.live;
    return next_call<PFN_vkAllocateMemory>(device, "vkAllocateMemory")(device, info, callbacks, memory);
}

VKAPI_ATTR void VKAPI_CALL free_memory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* callbacks) {
    if (memory != VK_NULL_HANDLE) --failures.live;
    next_call<PFN_vkFreeMemory>(device, "vkFreeMemory")(device, memory, callbacks);
}

/// A function that creates one object.
#define CREATE(name, Info, Handle)                                                                                 \
    VKAPI_ATTR VkResult VKAPI_CALL name(VkDevice device, const Info* info, const VkAllocationCallbacks* callbacks, \
                                        Handle* handle) {                                                          \
        if (fails(failures.objects, failures.first_object)) return VK_ERROR_OUT_OF_DEVICE_MEMORY;                  \
        return next_call<PFN_vk##name>(device, "vk" #name)(device, info, callbacks, handle);                       \
    }
CREATE(CreateBuffer, VkBufferCreateInfo, VkBuffer)
CREATE(CreateBufferView, VkBufferViewCreateInfo, VkBufferView)
CREATE(CreateImage, VkImageCreateInfo, VkImage)
CREATE(CreateImageView, VkImageViewCreateInfo, VkImageView)
CREATE(CreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)
CREATE(CreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
CREATE(CreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
CREATE(CreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
CREATE(CreateCommandPool, VkCommandPoolCreateInfo, VkCommandPool)
CREATE(CreateFence, VkFenceCreateInfo, VkFence)
CREATE(CreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool)
#undef CREATE

template <class Info>
using CreatePipelines = VkResult(VKAPI_PTR*)(VkDevice, VkPipelineCache, std::uint32_t, const Info*,
                                             const VkAllocationCallbacks*, VkPipeline*);

template <class Info>
VkResult create_pipelines(const char* name, VkDevice device, VkPipelineCache cache, std::uint32_t count,
                          const Info* infos, const VkAllocationCallbacks* callbacks, VkPipeline* pipelines) {
    if (fails(failures.objects, failures.first_object)) {
        std::memset(pipelines, 0, count * sizeof(VkPipeline));
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    return next_call<CreatePipelines<Info>>(device, name)(device, cache, count, infos, callbacks, pipelines);
}

VKAPI_ATTR VkResult VKAPI_CALL create_graphics(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                               const VkGraphicsPipelineCreateInfo* infos,
                                               const VkAllocationCallbacks* callbacks, VkPipeline* pipelines) {
    return create_pipelines("vkCreateGraphicsPipelines", device, cache, count, infos, callbacks, pipelines);
}
VKAPI_ATTR VkResult VKAPI_CALL create_compute(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                              const VkComputePipelineCreateInfo* infos,
                                              const VkAllocationCallbacks* callbacks, VkPipeline* pipelines) {
    return create_pipelines("vkCreateComputePipelines", device, cache, count, infos, callbacks, pipelines);
}

VKAPI_ATTR VkResult VKAPI_CALL allocate_sets(VkDevice device, const VkDescriptorSetAllocateInfo* info,
                                             VkDescriptorSet* sets) {
    if (fails(failures.objects, failures.first_object)) {
        std::memset(sets, 0, info->descriptorSetCount * sizeof(VkDescriptorSet));
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    return next_call<PFN_vkAllocateDescriptorSets>(device, "vkAllocateDescriptorSets")(device, info, sets);
}

bool lost() { return failures.submissions >= failures.first_submission; }

std::map<VkQueue, VkDevice> device_of;

VKAPI_ATTR void VKAPI_CALL get_queue(VkDevice device, std::uint32_t family, std::uint32_t index, VkQueue* queue) {
    next_call<PFN_vkGetDeviceQueue>(device, "vkGetDeviceQueue")(device, family, index, queue);
    const std::lock_guard lock(mutex);
    device_of[*queue] = device;
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
    if (fails(failures.submissions, failures.first_submission)) return VK_ERROR_DEVICE_LOST;
    VkDevice device = VK_NULL_HANDLE;
    {
        const std::lock_guard lock(mutex);
        device = device_of[queue];
    }
    return next_call<PFN_vkQueueSubmit2>(device, "vkQueueSubmit2")(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL wait(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                                    std::uint64_t timeout) {
    if (lost()) return VK_ERROR_DEVICE_LOST;
    const VkResult result =
        next_call<PFN_vkWaitForFences>(device, "vkWaitForFences")(device, count, fences, all, timeout);
    if (result != VK_SUCCESS || !failures.lose_in_wait.exchange(false)) return result;
    failures.first_submission = 0;
    return VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL fence_status(VkDevice device, VkFence fence) {
    if (lost()) return VK_ERROR_DEVICE_LOST;
    return next_call<PFN_vkGetFenceStatus>(device, "vkGetFenceStatus")(device, fence);
}

PFN_vkVoidFunction own(const char* name);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc(VkDevice device, const char* name) {
    if (const PFN_vkVoidFunction found = own(name)) return found;
    return next(device).device(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_proc(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction found = own(name)) return found;
    return instance == VK_NULL_HANDLE ? nullptr : next(instance).instance(instance, name);
}

PFN_vkVoidFunction own(const char* name) {
    const auto entry = [](auto function) { return reinterpret_cast<PFN_vkVoidFunction>(function); };
    static const std::map<std::string_view, PFN_vkVoidFunction> calls = {
        {"vkGetInstanceProcAddr", entry(&get_instance_proc)},
        {"vkGetDeviceProcAddr", entry(&get_device_proc)},
        {"vkCreateInstance", entry(&create_instance)},
        {"vkCreateDevice", entry(&create_device)},
        {"vkAllocateMemory", entry(&allocate_memory)},
        {"vkFreeMemory", entry(&free_memory)},
        {"vkCreateBuffer", entry(&CreateBuffer)},
        {"vkCreateBufferView", entry(&CreateBufferView)},
        {"vkCreateImage", entry(&CreateImage)},
        {"vkCreateImageView", entry(&CreateImageView)},
        {"vkCreateDescriptorPool", entry(&CreateDescriptorPool)},
        {"vkCreateDescriptorSetLayout", entry(&CreateDescriptorSetLayout)},
        {"vkCreatePipelineLayout", entry(&CreatePipelineLayout)},
        {"vkCreateShaderModule", entry(&CreateShaderModule)},
        {"vkCreateCommandPool", entry(&CreateCommandPool)},
        {"vkCreateFence", entry(&CreateFence)},
        {"vkCreateQueryPool", entry(&CreateQueryPool)},
        {"vkCreateGraphicsPipelines", entry(&create_graphics)},
        {"vkCreateComputePipelines", entry(&create_compute)},
        {"vkAllocateDescriptorSets", entry(&allocate_sets)},
        {"vkGetDeviceQueue", entry(&get_queue)},
        {"vkQueueSubmit2", entry(&submit)},
        {"vkWaitForFences", entry(&wait)},
        {"vkGetFenceStatus", entry(&fence_status)},
    };
    const auto found = calls.find(name);
    return found == calls.end() ? nullptr : found->second;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = &get_instance_proc;
    version->pfnGetDeviceProcAddr = &get_device_proc;
    version->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}

extern "C" __attribute__((visibility("default"))) Failures* pellucid_failures() { return &failures; }
