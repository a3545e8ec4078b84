// pellucid-reader: reads files by libraries that were not written for hostile ones. See core/read_apart.h.
#include "core/image_module.h"
#include "core/read_apart.h"
#include "scene/apart_readers.h"

#include <array>

int main() {
    using namespace pellucid;
    constexpr std::array<ApartReader, 3> kReaders = {read_image_here, read_3ds_here, read_vdb_here};
    serve_readers(kReaders);
}
