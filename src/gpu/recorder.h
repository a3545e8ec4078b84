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

/// What a draw renders into. Cleared attachments forget what they held.
struct RenderTarget {
    struct Attachment {
        const GpuImage* image;
        std::uint32_t layer;
        std::optional<vk::ClearValue> clear;
    };
    vk::Extent2D extent;
    std::vector<Attachment> colors = {};
    std::optional<Attachment> depth = {};
    vk::Rect2D scissor = {};  ///< zero extent: everything
};

/// Triangle corners of one object: the shader sees them as gl_VertexIndex, which counts in GpuScene::indices,
/// and the object as the first word of the push constants.
struct DrawCall {
    std::uint32_t first_corner;
    std::uint32_t corner_count;
    std::uint32_t object;
};

/// Records one frame's passes in the order of the calls. Each call names what it reads and writes and
/// gets its barriers from that; groups of calls are timed and labelled by scopes.
///
/// The names and accesses given are checked against the shader; a mismatch is a bug and throws
/// std::logic_error naming both sides. Resources that go while it is recorded, or runs, live on until it has run.
class Recorder {
public:
    explicit Recorder(const Device& device);

    /// Times and labels everything recorded while it lives. Scopes do not nest.
    class Scope {
    public:
        Scope(Recorder& recorder, std::string_view name);
        ~Scope();
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        Recorder& recorder_;
    };

    /// Runs at least `threads.width` x `threads.height` invocations; the shader drops the surplus.
    template <class Push>
    void compute(const Program& program, Bindings bindings, const Push& push, vk::Extent2D threads) {
        compute_bytes(program, bindings, std::as_bytes(std::span(&push, 1)), threads);
    }
    void compute(const Program& program, Bindings bindings, vk::Extent2D threads) {
        compute_bytes(program, bindings, {}, threads);
    }

    /// Runs as many workgroups as the first three words of `arguments` say when the device gets there.
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

    /// Builds a structure, or refits it, from `inputs`: the buffers or structures that it is made of.
    void build(const AccelerationStructure& structure, vk::BuildAccelerationStructureModeKHR mode,
               std::span<const ResourceId> inputs, const BuildScratch& scratch);

    void clear(const GpuImage& image, vk::ClearColorValue value);
    void clear_layer(const GpuImage& image, std::uint32_t layer, vk::ClearColorValue value);
    void fill(const Buffer& buffer, std::uint32_t word) { fill(buffer, 0, VK_WHOLE_SIZE, word); }
    void fill(const Buffer& buffer, vk::DeviceSize offset, vk::DeviceSize bytes, std::uint32_t word);
    void copy(const Buffer& source, const Buffer& destination, vk::DeviceSize bytes);
    /// From byte `offset` of `source` on, row by row, without gaps.
    void copy(const Buffer& source, vk::DeviceSize offset, const GpuImage& destination);
    /// Calls `then` with the T at byte `offset` of `source`, once what is being recorded has run.
    template <class T, class Then>
    void read(const Buffer& source, vk::DeviceSize offset, Then then) {
        when_done([from = read_bytes(source, offset, sizeof(T)), then = std::move(then)] {
            T value;
            std::memcpy(&value, from, sizeof(T));
            then(value);
        });
    }

    /// Writes `data`, of whole words, to byte `offset` of `buffer` once the device gets there.
    void write(const Buffer& buffer, std::span<const std::byte> data, vk::DeviceSize offset = 0) {
        write_bytes({buffer.handle(), buffer.id(), buffer.held(), {}, offset}, data);
    }
    template <class T>
    void write(const Buffer& buffer, const T& value) {
        write(buffer, std::as_bytes(std::span(&value, 1)));
    }
    /// What upload_later() was given since the last recording took it.
    void upload_pending();
    /// Copies a layer of `source` to an image of the caller's, of equal texels, that becomes readable in layout `after`.
    void copy_to(const GpuImage& source, vk::Image target, vk::Offset2D at, vk::ImageLayout before,
                 vk::ImageLayout after);

    /// Copies the caller's image, as large as `destination` and in layout `layout`, to it, texel by texel, in the format of that.
    void copy_from(vk::Image source, vk::ImageLayout layout, const GpuImage& destination);
    /// Copies depths of the caller's image, row by row.
    void copy_depths_from(vk::Image source, vk::ImageLayout layout, vk::Extent2D extent, const Buffer& destination);

    /// Runs `step` on the host between what is recorded before, whose results it sees in mapped buffers, and what is
    /// recorded after, which sees what it wrote there. Where it returns false, what is recorded from here to end_of_steps()
    /// is left out. A recording with such steps cannot be part of another's commands.
    void on_host(std::function<bool()> step);
    /// Ends the row of steps begun by the first on_host(), before the scope in which they are.
    void end_of_steps();

    /// Ends the recording, submits it and waits. Returns the time of each scope in recording order;
    /// scopes of one name are added up. The recorder is then empty and ready for the next frame.
    std::vector<PassTime> submit_and_wait();

    /// Commands, and what the host does once they have run.
    struct Part {
        vk::CommandBuffer commands;
        std::function<bool()> step;  ///< empty: the end of a row, or of the recording
    };
    /// Ends the recording. Its parts run one after the other (run_parts), the last one on the device. `done` is set in the end,
    /// if given.
    const std::vector<Part>& end(vk::Event done = {});
    /// Calls `submit` with the commands of one part after the other, each of which has run when it returns but for the last
    /// ones, and takes the host's steps.
    static void run_parts(std::span<const Part> parts, const std::function<void(vk::CommandBuffer, bool last)>& submit);
    /// After all of a recording that was ended has run: the times of its scopes, as submit_and_wait() has them. The recorder
    /// is then empty.
    std::vector<PassTime> finish();

    /// Forgets what was recorded, and begins anew: in `commands` of the caller's, which are recording, if given.
    void restart(vk::CommandBuffer commands = {});

    /// Calls `then` once what is being recorded has run; never if it is forgotten.
    void when_done(std::function<void()> then) { when_done_.push_back(std::move(then)); }

    const Device& device() const { return device_; }

private:
    /// What keeps a resource alive.
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
        std::optional<Use> write;  // the last,
        std::vector<Use> reads;    // and those since, which see it
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
    /// `uses_` are then those of the bindings.
    void bind(const Program& program, Bindings bindings, std::span<const std::byte> push);
    vk::DescriptorSet allocate_set(const Program& program);
    void write_timestamp(vk::PipelineStageFlagBits2 stage);
    std::vector<PassTime> read_times() const;

    const auto& dispatch() const { return *device_.handle().getDispatcher(); }

    const Device& device_;
    vk::raii::CommandPool pool_ = nullptr;
    std::vector<vk::raii::CommandBuffer> own_;  // kept from recording to recording
    std::size_t own_used_ = 0;
    vk::CommandBuffer commands_;  // what is being recorded: one of own_, or the caller's
    bool callers_ = false;
    std::vector<Part> parts_;  // before commands_
    vk::raii::Fence fence_ = nullptr;
    std::vector<vk::raii::DescriptorPool> descriptor_pools_;
    std::size_t descriptor_pool_ = 0;
    std::vector<vk::raii::QueryPool> query_pools_;
    std::vector<std::string> scopes_;  // one per pair of timestamps
    bool in_scope_ = false;
    std::uint32_t timestamps_ = 0;
    std::map<ResourceId, State> states_;
    // Of the pass that is being recorded; kept for their memory.
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
    std::vector<Buffer> read_buffers_;  // of kReadBufferSize, on the host
    vk::DeviceSize read_end_ = 0;       // in all of them
    std::vector<Buffer> staging_;       // on the host, what is written to buffers
    std::size_t staging_used_ = 0;
    vk::DeviceSize staging_end_ = 0;      // in the last that is used
    std::vector<PendingUpload> uploads_;  // that this recording has taken
};

}  // namespace pellucid
