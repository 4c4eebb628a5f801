// tests/layout/retired_words.h - words that gave way to the field's, and where they are found.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "layout/rules.h"

namespace obscura::layout {

/// A word that is no longer used. A pattern is matched against whole identifiers and words, as they
/// are written; "*" stands for any number of letters, digits and underscores. A pattern with blanks
/// is matched against words that follow each other with one blank in between.
///
/// To retire one more: an entry here; docs/glossary.md has the word to use instead.
struct RetiredWord {
    std::string_view pattern;
    std::string_view instead;
    std::string_view where = {};  ///< beginnings of paths, separated by spaces; empty: everywhere
};

inline constexpr std::array retired_words = {
    RetiredWord{"PathRows", "PathColumns"},
    RetiredWord{"HitRows", "HitColumns"},
    RetiredWord{"MissRows", "MissColumns"},
    RetiredWord{"ShadowRows", "ShadowColumns"},
    RetiredWord{"SampleRows", "SampleColumns"},
    RetiredWord{"ShapeRow", "ShapeRecord"},
    RetiredWord{"TextureRow", "TextureRecord"},
    RetiredWord{"TableRow", "TableRecord"},
    RetiredWord{"SceneRows", "SceneRecords"},
    RetiredWord{"ShadeRows", "ShadeColumns"},
    RetiredWord{"ScatterRows", "ScatterColumns"},
    RetiredWord{"ProbeRows", "ProbeColumns"},
    RetiredWord{"WallRows", "ThinWallColumns"},
    RetiredWord{"scene_rows", "scene_records"},
    RetiredWord{"shape_row", "shape_record"},
    RetiredWord{"texture_row", "texture_record"},
    RetiredWord{"*material_row", "material_record or material index"},
    RetiredWord{"LensRow", "LensEntry"},
    RetiredWord{"ReportRow", "ReportEntry"},
    RetiredWord{"OptionRow", "OptionEntry"},
    RetiredWord{"ExtensionRow", "ExtensionEntry"},
    RetiredWord{"FeatureRow", "FeatureEntry"},
    RetiredWord{"MaterialRow", "MaterialEntry"},
    RetiredWord{"IntegratorRow", "IntegratorEntry"},
    RetiredWord{"doors", "path state, columns"},
    RetiredWord{"*_doors", "path state, columns"},
    RetiredWord{"*Doors*", "PathState"},
    RetiredWord{"*orridor*", "wavefront pipeline"},
    RetiredWord{"WalkInput", "WavefrontInput"},
    RetiredWord{"WalkKind", "WavefrontKind"},
    RetiredWord{"WalkCounters", "WavefrontCounters"},
    RetiredWord{"walk_*", "trace_* or wavefront_*"},
    RetiredWord{"*walker*", "random walk"},
    RetiredWord{"*bodies*", "media, solids or dielectrics"},
    RetiredWord{"*Bodies*", "media, solids or dielectrics"},
    RetiredWord{"filling_body", "dominant_medium"},
    RetiredWord{"enter_body", "enter_medium"},
    RetiredWord{"leave_body", "leave_medium"},
    RetiredWord{"cross_walls", "cross_thin_walls"},
    RetiredWord{"waits_at_wall", "waits_at_thin_wall"},
    RetiredWord{"passes_wall*", "passes_thin_wall"},
    RetiredWord{"*uantit*", "AOV"},
    RetiredWord{"start_beyond", "starts_on_transmitted_side"},
    RetiredWord{"from_beyond", "transmitted side"},
    RetiredWord{"mover*", "dynamic group"},
    RetiredWord{"*_mover*", "dynamic group"},
    RetiredWord{"*Mover*", "dynamic group"},
    RetiredWord{"still_*", "static_*"},
    RetiredWord{"MeshBlock", "MeshBatch"},
    RetiredWord{"GeometryBlock", "GeometryBatch"},
    RetiredWord{"BlockReader", "BatchReader"},
    RetiredWord{"MeshPart", "MeshPrimitive"},
    RetiredWord{"SkinPart", "SkinPrimitive"},
    RetiredWord{"SplatPart", "SplatPrimitive"},
    RetiredWord{"PartReader", "PrimitiveReader"},
    RetiredWord{"PartJob", "PrimitiveTask"},
    RetiredWord{"Finding", "Verdict", "src/crosscheck tests/crosscheck"},
    RetiredWord{"ClosedPart*", "ClosedComponent"},
    RetiredWord{"strokes*", "points and lines, curves"},
    RetiredWord{"stroke_*", "points_lines"},
    RetiredWord{"*_stroke*", "points_lines"},
    RetiredWord{"*Stroke*", "PointsLines"},
    RetiredWord{"PieceTest", "SegmentRounding"},
    RetiredWord{"piece", "curve segment", "src/crosscheck tests/crosscheck docs/crosscheck.md"},
    RetiredWord{"pieces", "curve segments", "src/crosscheck tests/crosscheck docs/crosscheck.md"},
    RetiredWord{"film_thickness*", "thin_film_thickness"},
    RetiredWord{"film_strength", "thin_film_strength"},
    RetiredWord{"see_surface", "surface interaction"},
    RetiredWord{"SeenSurface", "SurfaceInteraction"},
    RetiredWord{"LookUp", "TextureFilter"},
    RetiredWord{"EmissionLook", "EmissionContext"},
    RetiredWord{"AlphaPlace", "AlphaCandidate"},
    RetiredWord{"LayerPlace", "LayerContext"},
    RetiredWord{"LightPathSum", "LightContribution"},
    RetiredWord{"FacetShares", "FacetWeights"},
    RetiredWord{"ReplayWay", "ReplayMode"},
    RetiredWord{"*_picture*", "image"},
    RetiredWord{"picture_*", "image"},
    RetiredWord{"*Picture*", "Image", "src tests benchmarks tools"},
    RetiredWord{"most_*", "max_*"},
    RetiredWord{"least_*", "min_*"},
    RetiredWord{"*ndless*", "infinite or unbounded"},
    RetiredWord{"without end", "infinite or unbounded"},
    RetiredWord{"fills the place", "dominant medium"},
};

/// Where a retired word stays, and why: it is somebody else's, or it means something else there.
struct KeptWord {
    std::string_view file;  ///< the beginning of a path
    std::string_view word;
    std::string_view reason;
};

inline constexpr std::array kept_words = {
    KeptWord{"src/gltf/parse/node_graph.cpp", "walk_down", "it visits the tree of nodes"},
    KeptWord{"docs/", "sample_pictures", "a document's name, to which other pages link"},
    KeptWord{"docs/", "make_lecture_pictures", "a script's name"},
};

/// True when all of `word` matches `pattern`, in which "*" stands for any run of characters.
inline bool matches(std::string_view pattern, std::string_view word) {
    while (!pattern.empty() && pattern.front() != '*') {
        if (word.empty() || word.front() != pattern.front()) return false;
        pattern.remove_prefix(1);
        word.remove_prefix(1);
    }
    if (pattern.empty()) return word.empty();
    for (size_t skipped = 0; skipped <= word.size(); ++skipped) {
        if (matches(pattern.substr(1), word.substr(skipped))) return true;
    }
    return false;
}

inline bool applies_to(const RetiredWord& retired, std::string_view file) {
    if (retired.where.empty()) return true;
    std::string_view rest = retired.where;
    while (!rest.empty()) {
        const size_t end = std::min(rest.find(' '), rest.size());
        if (file.starts_with(rest.substr(0, end))) return true;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
}

/// The kept word that lets `word` stay in a file; nullptr: it may not.
inline const KeptWord* find_kept(std::string_view file, std::string_view word) {
    for (const KeptWord& kept : kept_words) {
        if (kept.word == word && file.starts_with(kept.file)) return &kept;
    }
    return nullptr;
}

/// The same text with blank string and character literals, as long and with the same lines: names
/// of options, JSON keys and messages are not ours to change. Comments stay.
inline std::string without_literals(std::string_view text) {
    std::string out(text);
    for (size_t i = 0; i < text.size();) {
        size_t end = i + 1;
        const bool comment = text[i] == '/' && i + 1 < text.size();
        if (comment && (text[i + 1] == '/' || text[i + 1] == '*')) {
            end = comment_end(text, i);
        } else if (text[i] == '"' || (text[i] == '\'' && !is_digit_separator(text, i))) {
            end = literal_end(text, i);
            for (size_t k = i + 1; k + 1 < end; ++k) {
                if (out[k] != '\n') out[k] = ' ';
            }
        }
        i = end;
    }
    return out;
}

/// A word or identifier, where it stands in a text.
struct Word {
    std::string_view text;
    size_t line = 1;
    bool follows = false;  ///< one blank after the word before
};

inline std::vector<Word> split_words(std::string_view text) {
    std::vector<Word> words;
    size_t line = 1;
    size_t last_end = 0;
    for (size_t i = 0; i < text.size();) {
        if (!is_word(text[i])) {
            line += text[i] == '\n' ? 1 : 0;
            ++i;
            continue;
        }
        size_t end = i;
        while (end < text.size() && is_word(text[end]))
            ++end;
        const bool follows = !words.empty() && i == last_end + 1 && text[last_end] == ' ';
        words.push_back({text.substr(i, end - i), line, follows});
        last_end = end;
        i = end;
    }
    return words;
}

/// The words from `first` on that a pattern matches, as text; empty: it does not match there.
inline std::string match_at(const std::vector<Word>& words,
                            size_t first,
                            std::string_view pattern) {
    std::string found;
    for (size_t k = first; !pattern.empty(); ++k) {
        const size_t end = std::min(pattern.find(' '), pattern.size());
        if (k == words.size() || (k > first && !words[k].follows)) return {};
        if (!matches(pattern.substr(0, end), words[k].text)) return {};
        if (k > first) found += ' ';
        found += words[k].text;
        pattern.remove_prefix(std::min(end + 1, pattern.size()));
    }
    return found;
}

/// Refuses retired words in sources, without their string literals, in documents, and in names of
/// files, which are checked as texts of their own.
///
/// In      file: from the top of the tree: "src/scene/scene.h"
inline Problems check_retired_words(std::string_view file, std::string_view text) {
    const std::string plain =
        file.ends_with(".h") || file.ends_with(".cpp") ? without_literals(text) : std::string(text);
    const std::vector<Word> words = split_words(plain);
    Problems problems;
    for (size_t i = 0; i < words.size(); ++i) {
        for (const RetiredWord& retired : retired_words) {
            if (!applies_to(retired, file)) continue;
            const std::string found = match_at(words, i, retired.pattern);
            if (found.empty() || find_kept(file, found) != nullptr) continue;
            problems.push_back(problem(
                file, words[i].line, {"`", found, "` is retired: write ", retired.instead}));
        }
    }
    return problems;
}

}  // namespace obscura::layout
