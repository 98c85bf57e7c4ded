// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/standstill.hpp"
