// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/page.hpp"

namespace reckon {

std::string_view viewer_page() { return {}; }

}  // namespace reckon
