// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// An ESP32 with an MPU-6050 as a motion sensor on a tree: JSON over UDP, 50 times a second.
//
// Wiring of most boards: VCC to 3V3, GND to GND, SDA to GPIO 21, SCL to GPIO 22.
// On the computer:  tree-sway show oak.yaml --sensor tempest --motion udp:5006 --at 3.2
// Not compiled by the tests of this repository for a board: arduino-cli is not at hand there. They
// compile it for the computer, against stand-ins of the libraries, and read what it sends.

#include <WiFi.h>
#include <WiFiUdp.h>
#include <Wire.h>

const char *NETWORK = "your network";
const char *PASSWORD = "its password";
const char *COMPUTER = "192.168.1.10";  // where tree-sway runs
const uint16_t PORT = 5006;
const uint32_t PERIOD_US = 20000;

// Registers, ranges and scales: InvenSense, "MPU-6000 and MPU-6050 Register Map", revision 4.2.
const uint8_t MPU = 0x68, SAMPLE_RATE = 0x19, CONFIG = 0x1A, FIRST_VALUE = 0x3B, POWER = 0x6B;
const float GRAVITY = 9.80665f, PER_G = 16384.0f;        // of the range of 2 g
const float RADIAN = 0.01745329f, PER_DEGREE = 131.0f;   // of the range of 250 degrees per second

WiFiUDP udp;
uint32_t due;

void writeRegister(uint8_t name, uint8_t value) {
  Wire.beginTransmission(MPU);
  Wire.write(name);
  Wire.write(value);
  Wire.endTransmission();
}

// Reads acceleration, temperature and rate in one go, so that they belong together.
bool readSensor(int16_t values[7]) {
  Wire.beginTransmission(MPU);
  Wire.write(FIRST_VALUE);
  if (Wire.endTransmission(false) != 0) return false;
  if (Wire.requestFrom(MPU, (uint8_t)14) != 14) return false;
  for (int i = 0; i < 7; i++) {
    int high = Wire.read();
    int low = Wire.read();
    values[i] = (int16_t)((high << 8) | low);
  }
  return true;
}

void setup() {
  Wire.begin();
  writeRegister(POWER, 0x01);        // awake, clock of the gyroscope
  writeRegister(CONFIG, 0x04);       // low-pass at 20 Hz
  writeRegister(SAMPLE_RATE, 9);     // 100 samples per second
  WiFi.mode(WIFI_STA);
  WiFi.setSleep(false);              // a sleeping radio sends in bursts
  WiFi.begin(NETWORK, PASSWORD);
  due = micros();
}

void loop() {
  if ((int32_t)(micros() - due) < 0) return;
  due += PERIOD_US;
  int16_t v[7];
  if (WiFi.status() != WL_CONNECTED || !readSensor(v)) return;
  const float a = GRAVITY / PER_G, w = RADIAN / PER_DEGREE;
  char text[200];
  int length = snprintf(text, sizeof text,
      "{\"t\":%lu,\"ax\":%.4f,\"ay\":%.4f,\"az\":%.4f,\"gx\":%.5f,\"gy\":%.5f,\"gz\":%.5f}",
      (unsigned long)millis(), a * v[0], a * v[1], a * v[2], w * v[4], w * v[5], w * v[6]);
  udp.beginPacket(COMPUTER, PORT);
  udp.write((const uint8_t *)text, length);
  udp.endPacket();
}
