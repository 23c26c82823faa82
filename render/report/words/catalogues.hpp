#pragma once

#include "render/report/words/messages.hpp"

#include <span>

namespace macadam {

// Message catalogues of the reports: messages_en.cpp, messages_de.cpp, and for the comparison with
// references messages_reference_en.cpp, messages_reference_de.cpp, for the web page
// messages_site_en.cpp, messages_site_de.cpp. Every language has the same keys
// with the same placeholders, which a test verifies.
std::span<const Message> english_messages();
std::span<const Message> english_reference_messages();
std::span<const Message> english_site_messages();
std::span<const Message> german_messages();
std::span<const Message> german_reference_messages();
std::span<const Message> german_site_messages();

} // namespace macadam
