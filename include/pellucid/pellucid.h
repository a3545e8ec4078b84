#pragma once

// All of Pellucid's public interface.
#include <pellucid/animation.h>
#include <pellucid/api.h>
#include <pellucid/device.h>
#include <pellucid/display.h>
#include <pellucid/environment.h>
#include <pellucid/error.h>
#include <pellucid/exact_thickness.h>
#include <pellucid/file.h>
#include <pellucid/gltf_extensions.h>
#include <pellucid/image.h>
#include <pellucid/layer_builder.h>
#include <pellucid/light_options.h>
#include <pellucid/measure.h>
#include <pellucid/names.h>
#include <pellucid/photon_flux.h>
#include <pellucid/progress.h>
#include <pellucid/reference.h>
#include <pellucid/refracted_path.h>
#include <pellucid/renderer.h>
#include <pellucid/scene.h>
#include <pellucid/technique.h>
#include <pellucid/thickness.h>
#include <pellucid/volume.h>
#include <pellucid/volume_light.h>
#include <pellucid/voxelize.h>
