// app/dataset_request.cpp - turns the option texts of `obscura dataset` into a request.
// SPDX-License-Identifier: Apache-2.0
#include "app/dataset_request.h"

#include "app/dataset_options.h"
#include "app/list_options.h"
#include "app/part_options.h"
#include "session/image_names.h"

#include <fmt/format.h>

namespace obscura::app {

namespace {

/// What the options say of cameras around an asset.
Result<void> check_fill(const DatasetArguments& arguments, const ViewSampling& sampling) {
    if (sampling.fill[0] > sampling.fill[1])
        return conflict("--fill", "the lower number comes first, such as 0.5,0.9");
    if (sampling.space == ViewSpace::box && arguments.fill)
        return conflict("--fill", "it is of cameras around an asset; leave it out with box");
    return {};
}

/// The texts of one scene's rendering.
RenderArguments arguments_of(const DatasetArguments& arguments,
                             const RenderArguments& scene,
                             const dataset::SceneFolder& folder,
                             const ViewSampling& sampling) {
    RenderArguments out = scene;
    out.asset = folder.name;
    out.outputs = {(folder.folder / dataset::color_folder / "{view}.png").string()};
    if (arguments.layers_exr)
        out.outputs.push_back((folder.folder / "exr" / "{view}.exr").string());
    out.list.sampling = sampling;
    return out;
}

Result<void> choose_folder(const DatasetArguments& arguments, DatasetRequest& request) {
    if (!arguments.output || arguments.output->empty())
        return conflict("--output", "it is missing; give -o FOLDER");
    request.dataset.root = *arguments.output;
    if (!has_fields(request.dataset.root)) return {};
    return conflict("--output", "it is one folder, and no pattern; each scene has its own in it");
}

Result<void> add_scene(const DatasetArguments& arguments,
                       const RenderArguments& scene,
                       const std::optional<FilmPart>& part,
                       DatasetRequest& request) {
    const size_t number = request.scenes.size();
    const std::string own = scene.asset.empty()
                                ? name_part(std::filesystem::path(scene.scene_file).stem().string())
                                : scene.asset;
    const std::string name = request.dataset.formats.bop ? fmt::format("{:06}", number) : own;
    const dataset::SceneFolder folder{request.dataset.root / name, name, scene.scene_file};
    RenderArguments texts = arguments_of(arguments, scene, folder, request.sampling);
    Result<RenderRequest> render = make_render_request(texts);
    if (!render) return fail(render.error());
    render->load.places_nodes = true;
    render->lists.lists_only = arguments.dry_run;
    render->lists.shares_manifest = part.has_value();
    if (part) {
        render->part = part;
        render->part_by = PartBy::frames;
        render->lists.part_offset = number;
    }
    request.dataset.is_shared = part || render->long_run.skips_existing;
    request.dataset.scenes.push_back(folder);
    request.scenes.push_back({std::move(texts), std::move(*render)});
    return {};
}

}  // namespace

Result<DatasetRequest> make_dataset_request(const DatasetArguments& arguments) {
    DatasetArguments texts = arguments;
    const Command command = dataset_command(texts);
    if (auto fit = check_combinations(command.options); !fit) return fail(fit.error());
    DatasetRequest request;
    if (auto read = read_options(dataset_option_groups(), texts, request); !read)
        return fail(read.error());
    if (request.dataset.formats.nerf && !arguments.vary)
        request.sampling.turns_environment = request.sampling.chooses_variant = false;
    if (arguments.render.variant) request.sampling.chooses_variant = false;
    if (arguments.render.env_rotation) request.sampling.turns_environment = false;
    // What reads transforms.json takes steps of a millimetre, unless it is told otherwise.
    if (request.dataset.formats.nerf && !request.depth_unit_mm) request.depth_unit_mm = 1;
    if (request.dataset.formats.bop && arguments.render.lens.distortion) {
        return conflict("--distortion",
                        "cameras of BOP have none; leave it out, or leave out --write bop");
    }
    if (!arguments.render.aovs.empty() && !arguments.layers_exr)
        return conflict("--aov", "only EXRs hold layers; add --exr");
    request.dataset.count = request.sampling.count;
    if (auto fits = check_fill(arguments, request.sampling); !fits) return fail(fits.error());
    if (auto chosen = choose_folder(arguments, request); !chosen) return fail(chosen.error());
    std::optional<FilmPart> part;
    if (arguments.part) {
        const Result<FilmPart> parsed = parse_part(*arguments.part, "--part");
        if (!parsed) return fail(parsed.error());
        part = *parsed;
    }
    const Result<std::vector<RenderArguments>> scenes = arguments_of_scenes(arguments.render);
    if (!scenes) return fail(scenes.error());
    for (const RenderArguments& scene : *scenes) {
        if (auto added = add_scene(arguments, scene, part, request); !added)
            return fail(added.error());
    }
    return request;
}

}  // namespace obscura::app
