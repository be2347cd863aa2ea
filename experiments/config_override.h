#pragma once

#include <string>
#include <string_view>

#include "experiments/json_document.h"

namespace gradslc {

/// Applies one `--set`: "budget.spp=4", "methods.1.vpl.light_paths=1e5" or, as a JSON pointer, "/budget/spp=4".
/// The value is taken as JSON where it is JSON and as a string otherwise. Throws Error (input) where the assignment
/// cannot be read or leads nowhere; whether the key is known is for the document's reader to say.
void apply_override(JsonDocument& document, std::string_view assignment);

}  // namespace gradslc
