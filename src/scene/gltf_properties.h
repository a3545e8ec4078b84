#pragma once

#include "scene/tinygltf.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

namespace pellucid {

/// A number as the nearest int. tinygltf's GetNumberAsInt() is undefined for numbers beyond the range of int.
inline int gltf_integer(const tinygltf::Value& number) {
    using Limits = std::numeric_limits<int>;
    return static_cast<int>(std::clamp(number.GetNumberAsDouble(), double(Limits::min()), double(Limits::max())));
}

/// An extension's JSON object with defaults for what it lacks.
class GltfProperties {
public:
    GltfProperties(const tinygltf::ExtensionMap& extensions, const char* name) {
        const auto found = extensions.find(name);
        if (found != extensions.end()) object_ = &found->second;
    }
    bool present() const { return object_ != nullptr; }

    double number(const char* key, double otherwise) const {
        const tinygltf::Value* value = get(key);
        return value && value->IsNumber() ? value->GetNumberAsDouble() : otherwise;
    }
    /// Element of an array of numbers.
    double number(const char* key, int element, double otherwise) const {
        const tinygltf::Value* value = get(key);
        if (!value || !value->IsArray() || value->ArrayLen() <= std::size_t(element)) return otherwise;
        const tinygltf::Value& number = value->Get(element);
        return number.IsNumber() ? number.GetNumberAsDouble() : otherwise;
    }
    /// A textureInfo object, as tinygltf returns those outside of extensions.
    tinygltf::TextureInfo texture(const char* key) const {
        tinygltf::TextureInfo info;
        const tinygltf::Value* value = get(key);
        if (!value || !value->IsObject()) return info;
        const auto integer = [&](const char* name, int otherwise) {
            if (!value->Has(name) || !value->Get(name).IsNumber()) return otherwise;
            return gltf_integer(value->Get(name));
        };
        info.index = integer("index", -1);
        info.texCoord = integer("texCoord", 0);
        if (value->Has("extensions") && value->Get("extensions").IsObject())
            for (const std::string& name : value->Get("extensions").Keys())
                info.extensions[name] = value->Get("extensions").Get(name);
        return info;
    }
    /// A number of a textureInfo object.
    double texture_number(const char* key, const char* name, double otherwise) const {
        const tinygltf::Value* value = get(key);
        if (!value || !value->IsObject() || !value->Has(name) || !value->Get(name).IsNumber()) return otherwise;
        return value->Get(name).GetNumberAsDouble();
    }

private:
    const tinygltf::Value* get(const char* key) const {
        if (!object_ || !object_->IsObject() || !object_->Has(key)) return nullptr;
        return &object_->Get(std::string(key));
    }
    const tinygltf::Value* object_ = nullptr;
};

}  // namespace pellucid
