#pragma once

#include "gpu/acceleration_structure.h"
#include "gpu/binding.h"
#include "gpu/memory.h"
#include "gpu/program.h"

#include <pellucid/device.h>

#include <array>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace pellucid {

inline vk::ClearValue clear_to(float value) { return vk::ClearColorValue(std::array{value, value, value, value}); }
inline vk::ClearValue clear_to(std::array<std::uint32_t, 4> value) { return vk::ClearColorValue(value); }
inline vk::ClearValue clear_to_farthest() { return vk::ClearDepthStencilValue{1.0f, 0}; }

/// The attachments of a draw. Attachments without `clear` keep their contents.
struct RenderTarget {
    struct Attachment {
        const GpuImage* image;
        std::uint32_t layer;
        std::optional<vk::ClearValue> clear;
    };
    vk::Extent2D extent;
    std::vector<Attachment> colors = {};
    std::optional<Attachment> depth = {};
    vk::Rect2D scissor = {};  ///< zero extent: the whole target
};

/// A range of triangle corners of one object. gl_VertexIndex is the position of a corner in GpuScene::indices. The
/// object is the first word of the push constants.
struct DrawCall {
    std::uint32_t first_corner;
    std::uint32_t corner_count;
    std::uint32_t object;
};

/// Records one frame's passes in the order of the calls. Each call names the resources that it reads and writes, from
/// which the recorder derives barriers. Scopes time and label groups of calls.
///
/// Names and accesses are checked against the shader. A mismatch is a bug and throws std::logic_error naming both
/// sides. Resources that are destroyed during recording or execution stay alive until the frame has run.
class Recorder {
public:
    explicit Recorder(const Device& device);

    /// Times and labels everything that is recorded during the scope's lifetime. Scopes do not nest.
    class Scope {
    public:
        Scope(Recorder& recorder, std::string_view name);
        ~Scope();
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        Recorder& recorder_;
    };

    /// Runs at least `threads.width` x `threads.height` invocations. The shader must ignore the surplus.
    template <class Push>
    void compute(const Program& program, Bindings bindings, const Push& push, vk::Extent2D threads) {
        compute_bytes(program, bindings, std::as_bytes(std::span(&push, 1)), threads);
    }
    void compute(const Program& program, Bindings bindings, vk::Extent2D threads) {
        compute_bytes(program, bindings, {}, threads);
    }

    /// Runs the number of workgroups in the first three words of `arguments`, which the device reads on execution.
    template <class Push>
    void compute_indirect(const Program& program, Bindings bindings, const Push& push, const Buffer& arguments) {
        compute_indirect_bytes(program, bindings, std::as_bytes(std::span(&push, 1)), arguments);
    }
    void compute_indirect(const Program& program, Bindings bindings, const Buffer& arguments) {
        compute_indirect_bytes(program, bindings, {}, arguments);
    }

    template <class Push>
    void draw(const Program& program, Bindings bindings, const Push& push, const RenderTarget& target,
              std::span<const DrawCall> calls) {
        draw_bytes(program, bindings, std::as_bytes(std::span(&push, 1)), target, calls);
    }

    void draw(const Program& program, Bindings bindings, const RenderTarget& target, std::span<const DrawCall> calls) {
        draw_bytes(program, bindings, {}, target, calls);
    }

    /// Builds or refits a structure. `inputs`: the buffers or structures from which it is built.
    void build(const AccelerationStructure& structure, vk::BuildAccelerationStructureModeKHR mode,
               std::span<const ResourceId> inputs, const BuildScratch& scratch);

    void clear(const GpuImage& image, vk::ClearColorValue value);
    void clear_layer(const GpuImage& image, std::uint32_t layer, vk::ClearColorValue value);
    void fill(const Buffer& buffer, std::uint32_t word) { fill(buffer, 0, VK_WHOLE_SIZE, word); }
    void fill(const Buffer& buffer, vk::DeviceSize offset, vk::DeviceSize bytes, std::uint32_t word);
    void copy(const Buffer& source, const Buffer& destination, vk::DeviceSize bytes);
    /// Copies tightly packed rows, from byte `offset` of `source` on, to an image.
    void copy(const Buffer& source, vk::DeviceSize offset, const GpuImage& destination);
    /// Calls `then` with the T at byte `offset` of `source`, once the recording has run.
    template <class T, class Then>
    void read(const Buffer& source, vk::DeviceSize offset, Then then) {
        when_done([from = read_bytes(source, offset, sizeof(T)), then = std::move(then)] {
            T value;
            std::memcpy(&value, from, sizeof(T));
            then(value);
        });
    }

    /// Records a write of `data`, whole words, to byte `offset` of `buffer`.
    void write(const Buffer& buffer, std::span<const std::byte> data, vk::DeviceSize offset = 0) {
        write_bytes({buffer.handle(), buffer.id(), buffer.held(), {}, offset}, data);
    }
    template <class T>
    void write(const Buffer& buffer, const T& value) {
        write(buffer, std::as_bytes(std::span(&value, 1)));
    }
    /// Records the uploads that upload_later() has collected since the last recording.
    void upload_pending();
    /// Copies the first layer of `source` to the caller's image, which must have an equal texel format. The caller's
    /// image goes from layout `before` to layout `after`.
    void copy_to(const GpuImage& source, vk::Image target, vk::Offset2D at, vk::ImageLayout before,
                 vk::ImageLayout after);

    /// Copies the caller's image texel by texel to `destination`, which has the same size, and converts the format.
    /// `layout`: layout of the caller's image.
    void copy_from(vk::Image source, vk::ImageLayout layout, const GpuImage& destination);
    /// Copies depths of the caller's image, row by row.
    void copy_depths_from(vk::Image source, vk::ImageLayout layout, vk::Extent2D extent, const Buffer& destination);

    /// Runs `step` on the host between the commands recorded before and after. The step sees earlier results in mapped
    /// buffers, and later commands see its writes. If it returns false, all commands from here to end_of_steps() are
    /// skipped. A recording with steps cannot use the caller's command buffer.
    void on_host(std::function<bool()> step);
    /// Ends the sequence of steps that the first on_host() began. Call it before their scope ends.
    void end_of_steps();

    /// Ends the recording, submits it and waits. Returns the time of each scope in recording order; times of equal
    /// names are added up. The recorder is then empty and ready for the next frame.
    std::vector<PassTime> submit_and_wait();

    /// Commands, and the host's step after them.
    struct Part {
        vk::CommandBuffer commands;
        std::function<bool()> step;  ///< empty: end of a sequence of steps, or of the recording
    };
    /// Ends the recording and returns its parts, for run_parts(). `done`: if given, the device sets it at the end.
    const std::vector<Part>& end(vk::Event done = {});
    /// Calls `submit` with the commands of each part, and runs the host's step after each. `submit` must wait until the
    /// commands have run, except for the last part.
    static void run_parts(std::span<const Part> parts, const std::function<void(vk::CommandBuffer, bool last)>& submit);
    /// Returns the times of the scopes, as submit_and_wait() does. Call after the ended recording has run. The recorder
    /// is then empty.
    std::vector<PassTime> finish();

    /// Discards the recording and starts a new one, in the caller's command buffer if `commands` is given. That buffer
    /// must be in recording state.
    void restart(vk::CommandBuffer commands = {});

    /// Calls `then` once the recording has run; never if the recording is discarded.
    void when_done(std::function<void()> then) { when_done_.push_back(std::move(then)); }

    const Device& device() const { return device_; }

private:
    /// Keeps a resource alive.
    using Holder = std::shared_ptr<const void>;
    struct Use {
        ResourceId id;
        vk::PipelineStageFlags2 stage;
        vk::AccessFlags2 access;
        bool write;
        Holder holder = {};
        bool covers(const Use& other) const {
            return (stage & other.stage) == other.stage && (access & other.access) == other.access;
        }
    };
    struct State {
        std::optional<Use> write;  // the last write
        std::vector<Use> reads;    // reads since the last write, which see its result
        Holder holder;
    };
    template <class Resource>
    static Use use_of(const Resource& resource, vk::PipelineStageFlags2 stage, vk::AccessFlags2 access, bool write) {
        return {resource.id(), stage, access, write, resource.held()};
    }

    void compute_bytes(const Program& program, Bindings bindings, std::span<const std::byte> push,
                       vk::Extent2D threads);
    void compute_indirect_bytes(const Program& program, Bindings bindings, std::span<const std::byte> push,
                                const Buffer& arguments);
    void draw_bytes(const Program& program, Bindings bindings, std::span<const std::byte> push,
                    const RenderTarget& target, std::span<const DrawCall> calls);
    const std::byte* read_bytes(const Buffer& source, vk::DeviceSize offset, vk::DeviceSize bytes);
    void begin_commands();
    void begin_label();
    void add_step(std::function<bool()> step);
    void end_label();
    void make_visible_to_host();
    void change_layout(vk::Image image, vk::ImageLayout from, vk::ImageLayout to);
    void synchronise(std::span<Use> uses);
    void synchronise(Use use) { synchronise(std::span(&use, 1)); }
    void write_bytes(const PendingUpload& to, std::span<const std::byte> data);
    std::byte* stage(vk::DeviceSize bytes, const Buffer*& buffer, vk::DeviceSize& offset);
    /// Binds the program and its resources, and sets `uses_` to the uses of the bindings.
    void bind(const Program& program, Bindings bindings, std::span<const std::byte> push);
    vk::DescriptorSet allocate_set(const Program& program);
    void write_timestamp(vk::PipelineStageFlagBits2 stage);
    std::vector<PassTime> read_times() const;

    const auto& dispatch() const { return *device_.handle().getDispatcher(); }

    const Device& device_;
    vk::raii::CommandPool pool_ = nullptr;
    std::vector<vk::raii::CommandBuffer> own_;  // reused by the next recording
    std::size_t own_used_ = 0;
    vk::CommandBuffer commands_;  // in recording state: one of own_, or the caller's
    bool callers_ = false;
    std::vector<Part> parts_;  // ended parts, which run before commands_
    vk::raii::Fence fence_ = nullptr;
    std::vector<vk::raii::DescriptorPool> descriptor_pools_;
    std::size_t descriptor_pool_ = 0;
    std::vector<vk::raii::QueryPool> query_pools_;
    std::vector<std::string> scopes_;  // one per pair of timestamps
    bool in_scope_ = false;
    std::uint32_t timestamps_ = 0;
    std::map<ResourceId, State> states_;
    // Scratch data of the current pass; members, so that their memory is reused.
    std::vector<Use> uses_;
    struct Descriptors {
        std::vector<vk::WriteDescriptorSet> writes;
        std::vector<vk::DescriptorBufferInfo> buffers;
        std::vector<vk::DescriptorImageInfo> images;
        std::vector<vk::BufferView> texels;
        std::vector<vk::AccelerationStructureKHR> structures;
        std::vector<vk::WriteDescriptorSetAccelerationStructureKHR> structure_writes;
    } descriptors_;
    std::vector<std::function<void()>> when_done_;
    std::vector<Buffer> read_buffers_;  // host memory, kReadBufferSize bytes each
    vk::DeviceSize read_end_ = 0;       // bytes used, over all read_buffers_
    std::vector<Buffer> staging_;       // host memory for data written to buffers
    std::size_t staging_used_ = 0;
    vk::DeviceSize staging_end_ = 0;      // bytes used in the last used buffer of staging_
    std::vector<PendingUpload> uploads_;  // uploads that this recording has taken
};

}  // namespace pellucid
