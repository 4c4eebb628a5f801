// image/ocio_cycles.cpp - detects circular references in an OpenColorIO config.
// SPDX-License-Identifier: Apache-2.0
#include "image/ocio_cycles.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <vector>

namespace obscura {

namespace ocio = OCIO_NAMESPACE;

namespace {

/// Maximum nesting of names: OpenColorIO needs a few hundred bytes of stack for each.
constexpr size_t deepest = 200;
/// Maximum number of transforms of a processor; a chain of doublings would exceed any memory.
constexpr double max_transforms = 100000;

/// Follows references depth first. Both directions of everything: OpenColorIO collects context
/// variables from both, whichever it will use.
class References {
public:
    explicit References(const ocio::Config& config)
        : config_(config), context_(config.getCurrentContext()) {
        for (int i = 0; i < config.getNumEnvironmentVars(); ++i) {
            const char* name = config.getEnvironmentVarNameByIndex(i);
            follow_variables(std::string("$").append(name));
        }
        follow_variables(config.getSearchPath());
    }

    void follow(const ocio::ConstTransformRcPtr& transform);
    std::string problem() const {
        if (problem_.empty() && size_ > max_transforms) {
            return "its references make more than 100000 transforms";
        }
        return problem_;
    }

private:
    template <typename Follow>
    void enter(const std::string& label, const Follow& content);
    void follow_variables(const std::string& text);
    std::string resolved(const char* text);
    void follow_space(const char* name);
    void follow_looks(const char* names);
    void follow_look(const std::string& name);
    void follow_view(const char* display, const char* view);
    void follow_view_transform(const ocio::ConstViewTransformRcPtr& transform);
    void tell_circle(const std::string& label);

    const ocio::Config& config_;
    ocio::ConstContextRcPtr context_;
    std::vector<std::string> open_;        ///< labels on the way from the root
    std::map<std::string, double> known_;  ///< transforms below each label
    double size_ = 0;                      ///< transforms so far
    std::string problem_;
};

void References::tell_circle(const std::string& label) {
    size_t first = 0;
    while (open_[first] != label)
        ++first;
    problem_ = "refers to itself in a circle: ";
    for (size_t i = first; i < open_.size(); ++i)
        problem_ += open_[i] + " -> ";
    problem_ += label;
}

/// Follows the content of a name, once.
template <typename Follow>
void References::enter(const std::string& label, const Follow& content) {
    if (!problem_.empty()) return;
    const auto known = known_.find(label);
    if (known != known_.end()) {
        size_ += known->second;
        return;
    }
    for (const std::string& open : open_) {
        if (open == label) return tell_circle(label);
    }
    if (open_.size() >= deepest) {
        problem_ =
            "its references are nested more than " + std::to_string(deepest) + " deep, at " + label;
        return;
    }
    open_.push_back(label);
    const double before = size_;
    content();
    known_[label] = size_ - before;
    open_.pop_back();
}

/// Follows variables ($NAME, ${NAME}, %NAME%), whose values may contain others. OpenColorIO also
/// takes a variable whose name is only the start of the word.
void References::follow_variables(const std::string& text) {
    if (text.find_first_of("$%") == std::string::npos) return;
    for (int i = 0; i < context_->getNumStringVars(); ++i) {
        const std::string name = context_->getStringVarNameByIndex(i);
        const std::string value = context_->getStringVarByIndex(i);
        const std::string forms[] = {"$" + name, "${" + name + "}", "%" + name + "%"};
        const auto is_in = [&](const std::string& form) {
            return text.find(form) != std::string::npos;
        };
        if (std::none_of(std::begin(forms), std::end(forms), is_in)) continue;
        if (value == forms[0]) continue;  // nothing changes: OpenColorIO stops
        enter("variable '" + name + "'", [&] { follow_variables(value); });
    }
}

/// A text with its variables replaced by their values; "" if they are circular.
std::string References::resolved(const char* text) {
    follow_variables(text);
    return problem_.empty() ? context_->resolveStringVar(text) : "";
}

void References::follow_space(const char* name) {
    const std::string meant = resolved(name);
    if (const ocio::ConstColorSpaceRcPtr space = config_.getColorSpace(meant.c_str())) {
        enter("colour space '" + std::string(space->getName()) + "'", [&] {
            follow(space->getTransform(ocio::COLORSPACE_DIR_TO_REFERENCE));
            follow(space->getTransform(ocio::COLORSPACE_DIR_FROM_REFERENCE));
        });
    } else if (const auto named = config_.getNamedTransform(meant.c_str())) {
        enter("named transform '" + std::string(named->getName()) + "'", [&] {
            follow(named->getTransform(ocio::TRANSFORM_DIR_FORWARD));
            follow(named->getTransform(ocio::TRANSFORM_DIR_INVERSE));
        });
    }
}

/// Looks as "one, -two | three".
void References::follow_looks(const char* names) {
    std::string name;
    for (const char c : resolved(names) + ",") {
        if (c == ',' || c == '|' || c == ':') {
            follow_look(name);
            name.clear();
        } else if (!name.empty() || (c != ' ' && c != '\t' && c != '+' && c != '-')) {
            name += c;
        }
    }
}

void References::follow_look(const std::string& name) {
    const size_t end = name.find_last_not_of(" \t");
    const std::string trimmed = end == std::string::npos ? "" : name.substr(0, end + 1);
    const ocio::ConstLookRcPtr look = config_.getLook(trimmed.c_str());
    if (!look) return;
    enter("look '" + std::string(look->getName()) + "'", [&] {
        follow_space(look->getProcessSpace());
        follow(look->getTransform());
        follow(look->getInverseTransform());
    });
}

void References::follow_view_transform(const ocio::ConstViewTransformRcPtr& transform) {
    if (!transform) return;
    enter("view transform '" + std::string(transform->getName()) + "'", [&] {
        follow(transform->getTransform(ocio::VIEWTRANSFORM_DIR_TO_REFERENCE));
        follow(transform->getTransform(ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE));
    });
}

void References::follow_view(const char* display, const char* view) {
    const std::string on = resolved(display);
    const std::string name = resolved(view);
    enter("view '" + name + "' of display '" + on + "'", [&] {
        const char* space = config_.getDisplayViewColorSpaceName(on.c_str(), name.c_str());
        const std::string shown = space != nullptr ? space : "";
        follow_space(shown == "<USE_DISPLAY_NAME>" ? on.c_str() : shown.c_str());
        follow_looks(config_.getDisplayViewLooks(on.c_str(), name.c_str()));
        const char* transform = config_.getDisplayViewTransformName(on.c_str(), name.c_str());
        if (transform == nullptr || *transform == '\0') {
            follow_view_transform(config_.getDefaultSceneToDisplayViewTransform());
        } else {
            follow_view_transform(config_.getViewTransform(transform));
        }
    });
}

void References::follow(const ocio::ConstTransformRcPtr& transform) {
    if (!transform || !problem_.empty()) return;
    size_ += 1;
    if (const auto group = ocio::DynamicPtrCast<const ocio::GroupTransform>(transform)) {
        for (int i = 0; i < group->getNumTransforms(); ++i)
            follow(group->getTransform(i));
    } else if (const auto space =
                   ocio::DynamicPtrCast<const ocio::ColorSpaceTransform>(transform)) {
        follow_space(space->getSrc());
        follow_space(space->getDst());
    } else if (const auto look = ocio::DynamicPtrCast<const ocio::LookTransform>(transform)) {
        follow_space(look->getSrc());
        follow_space(look->getDst());
        follow_looks(look->getLooks());
    } else if (const auto view =
                   ocio::DynamicPtrCast<const ocio::DisplayViewTransform>(transform)) {
        follow_space(view->getSrc());
        follow_view(view->getDisplay(), view->getView());
    } else if (const auto file = ocio::DynamicPtrCast<const ocio::FileTransform>(transform)) {
        follow_variables(file->getSrc());
        follow_variables(file->getCCCId());
    }
}

}  // namespace

std::string cyclic_references(const ocio::Config& config,
                              const ocio::ConstTransformRcPtr& transform) {
    References references(config);
    references.follow(transform);
    return references.problem();
}

}  // namespace obscura
