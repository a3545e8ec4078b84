// pellucid-reader: reads files by libraries that were not written for hostile ones. See core/read_apart.h.
#include "core/image_module.h"
#include "core/read_apart.h"
#include "scene/apart_readers.h"

#include <array>

int main() {
    using namespace pellucid;
    const std::array<ServedReader, 3> readers = {ServedReader{read_image_here, load_image_module},
                                                 ServedReader{read_3ds_here}, ServedReader{read_vdb_here}};
    serve_readers(readers);
}
