// python/module/image.cpp - Image: a mapping from names of layers to arrays of their pixels.
// SPDX-License-Identifier: Apache-2.0
#include "pixels.h"
#include "session.h"
#include <algorithm>

namespace obscura::python {

namespace {

using ImagePointer = std::shared_ptr<Image>;

constexpr const char* beauty = "beauty";

/// A layer of an image, which it keeps alive.
struct LayerOf {
    ImagePointer image;
    const Layer* layer;
};

py::array_t<float> beauty_of(const ImagePointer& image) {
    return pixels_of({image->part.width, image->part.height, image->channels.size()},
                     image->pixels,
                     py::cast(image));
}

py::array_t<float> layer_pixels(const LayerOf& of) {
    const Rect& part = of.image->part;
    return pixels_of(
        {part.width, part.height, of.layer->channels.size()}, of.layer->pixels, py::cast(of.image));
}

std::vector<std::string> names_of(const Image& image) {
    std::vector<std::string> out = {beauty};
    for (const Layer& layer : image.layers)
        out.push_back(layer.name);
    return out;
}

const Layer* find_layer(const Image& image, const std::string& name) {
    const auto found = std::find_if(image.layers.begin(),
                                    image.layers.end(),
                                    [&](const Layer& layer) { return layer.name == name; });
    return found == image.layers.end() ? nullptr : &*found;
}

[[noreturn]] void no_layer(const Image& image, const std::string& name) {
    std::string list;
    for (const std::string& known : names_of(image))
        list += (list.empty() ? "" : ", ") + known;
    throw py::key_error("the image has no layer '" + name + "'; it has: " + list);
}

LayerOf layer_named(const ImagePointer& image, const std::string& name) {
    const Layer* const layer = find_layer(*image, name);
    if (layer == nullptr) no_layer(*image, name);
    return {image, layer};
}

py::array_t<float> pixels_named(const ImagePointer& image, const std::string& name) {
    return name == beauty ? beauty_of(image) : layer_pixels(layer_named(image, name));
}

py::dict attributes_of(const std::vector<std::pair<std::string, std::string>>& list) {
    py::dict out;
    for (const auto& [name, value] : list)
        out[text(name)] = text(value);
    return out;
}

py::dict ids_of(const Layer& layer) {
    py::dict out;
    for (const CryptomatteName& one : layer.names)
        out[text(one.name)] = one.id;
    return out;
}

py::list values_of(Image& image) {
    const auto shared = py::cast(image, py::return_value_policy::reference).cast<ImagePointer>();
    py::list out;
    for (const std::string& name : names_of(image))
        out.append(pixels_named(shared, name));
    return out;
}

void bind_layer(py::module_& module) {
    py::class_<LayerOf>(module, "Layer", "A layer beside the beauty; docs/layers.md has the units.")
        .def_property_readonly("name", [](const LayerOf& of) { return text(of.layer->name); })
        .def_property_readonly(
            "channels",
            [](const LayerOf& of) { return texts(of.layer->channels); },
            "As in a file: ('normal.X', 'normal.Y', 'normal.Z').")
        .def_property_readonly(
            "kind",
            [](const LayerOf& of) { return name_of(of.layer->kind); },
            "'color' may be rounded, 'id' must keep every bit; else 'data'.")
        .def_property_readonly(
            "reduction",
            [](const LayerOf& of) { return text(of.layer->reduction); },
            "How samples became a pixel: 'mean', 'nearest', 'count', 'variance', 'cryptomatte'.")
        .def_property_readonly(
            "expression",
            [](const LayerOf& of) { return text(of.layer->expression); },
            "The light path expression that it shows; '' where it shows none.")
        .def_property_readonly(
            "pixels", layer_pixels, "(height, width, channels) float32, not copied.")
        .def_property_readonly(
            "ids",
            [](const LayerOf& of) { return ids_of(*of.layer); },
            "Of a Cryptomatte layer: {'/room/lamp': id}, as its pixels have it.")
        .def_property_readonly(
            "attributes",
            [](const LayerOf& of) { return attributes_of(of.layer->attributes); },
            "What an EXR's header says of it besides: {name: text}.");
}

void bind_statistics(py::module_& module) {
    py::class_<ImageStatistics>(module, "Statistics", "How a rendering went.")
        .def_readonly("render_seconds", &ImageStatistics::render_seconds)
        .def_readonly("paths", &ImageStatistics::paths)
        .def_readonly("rays", &ImageStatistics::rays)
        .def_readonly(
            "nonfinite_samples", &ImageStatistics::nonfinite_samples, "They count as zero.");
}

constexpr const char* image_doc = R"(A rendered image: a mapping from names to arrays of pixels.

image['beauty'] and image['normal'], as Sampling.aov asked for it, are (height, width, channels)
float32 arrays on the memory of the library, without a copy; they stay when the image is gone.
Row 0 is on top. The beauty is scene-linear Rec.709 in nit, its alpha premultiplied. What is
changed in an array is changed in what Session.write() writes.)";

void bind_mapping(py::class_<Image, ImagePointer>& image) {
    image.def("__getitem__", pixels_named, py::arg("name"))
        .def("__len__", [](const Image& self) { return 1 + self.layers.size(); })
        .def("__iter__", [](const Image& self) { return py::iter(texts(names_of(self))); })
        .def("__contains__",
             [](const Image& self, const py::object& name) {
                 return texts(names_of(self)).contains(name);
             })
        .def("keys", [](const Image& self) { return texts(names_of(self)); })
        .def("values", values_of)
        .def("items",
             [](Image& self) {
                 return py::list(py::module_::import("builtins")
                                     .attr("zip")(texts(names_of(self)), values_of(self)));
             })
        .def(
            "get",
            [](const ImagePointer& self, const std::string& name, const py::object& otherwise) {
                const bool known = name == beauty || find_layer(*self, name) != nullptr;
                return known ? py::object(pixels_named(self, name)) : otherwise;
            },
            py::arg("name"),
            py::arg("default") = py::none());
}

}  // namespace

py::array_t<float> pixels_of(const PixelShape& shape,
                             const std::vector<float>& pixels,
                             const py::object& owner) {
    const auto channels = static_cast<py::ssize_t>(shape.channels);
    const std::array<py::ssize_t, 3> sides = {shape.height, shape.width, channels};
    return py::array_t<float>(sides, strides_of<float>(sides), pixels.data(), owner);
}

void bind_image(py::module_& module) {
    bind_layer(module);
    bind_statistics(module);
    py::class_<Image, ImagePointer> image(module, "Image", image_doc);
    bind_mapping(image);
    image.def_readonly("width", &Image::width, "Of the whole image, pixels.")
        .def_readonly("height", &Image::height, "Of the whole image, pixels.")
        .def_property_readonly(
            "part",
            [](const Image& self) { return Plain<Rect>::to(self.part); },
            "(x, y, width, height): which part of the whole the pixels are.")
        .def(
            "channels",
            [](const ImagePointer& self, const std::string& name) {
                return texts(name == beauty ? self->channels
                                            : layer_named(self, name).layer->channels);
            },
            py::arg("name") = beauty,
            "The channels' names: ('R', 'G', 'B', 'A'), ('normal.X', 'normal.Y', 'normal.Z').")
        .def("layer", layer_named, py::arg("name"), "All that is known of a layer.")
        .def_property_readonly(
            "attributes",
            [](const Image& self) { return attributes_of(self.attributes); },
            "What an EXR's header says besides: {'obscura:camera': '...'}.")
        .def_readonly("statistics", &Image::statistics)
        .def("__repr__", [](const Image& self) {
            std::string list;
            for (const std::string& name : names_of(self))
                list += (list.empty() ? "" : ", ") + name;
            return text("<obscura.Image " + std::to_string(self.part.width) + "x" +
                        std::to_string(self.part.height) + ": " + list + ">");
        });
}

}  // namespace obscura::python
