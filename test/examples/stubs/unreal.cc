// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// What the example takes from Unreal, and a program that runs it. No engine is here.
#include <stdint.h>
#include <stdio.h>
#include <string>
#include <vector>

#define UCLASS(...)
#define UPROPERTY(...)
#define GENERATED_BODY()
#define TEXT(text) text
#define TCHAR_TO_UTF8(text) (text)
#define UTF8_TO_TCHAR(text) (text)
#define UE_LOG(category, level, ...) fprintf(stderr, __VA_ARGS__)
#define UE_DOUBLE_INV_SQRT_2 0.70710678118654752

typedef int32_t int32;
enum ELevelTick { LEVELTICK_All };
struct FActorComponentTickFunction {
  bool bCanEverTick = false;
};

struct FString : std::string {
  using std::string::string;
  const char *operator*() const { return c_str(); }
};

struct FVector {
  double X = 0.0, Y = 0.0, Z = 0.0;
  FVector() = default;
  FVector(double x, double y, double z) : X(x), Y(y), Z(z) {}
  FVector operator+(const FVector &v) const { return {X + v.X, Y + v.Y, Z + v.Z}; }
};

struct FQuat {
  double X = 0.0, Y = 0.0, Z = 0.0, W = 1.0;
  FQuat() = default;
  FQuat(double x, double y, double z, double w) : X(x), Y(y), Z(z), W(w) {}
  FQuat operator*(const FQuat &q) const {
    return {W * q.X + X * q.W + Y * q.Z - Z * q.Y, W * q.Y - X * q.Z + Y * q.W + Z * q.X,
            W * q.Z + X * q.Y - Y * q.X + Z * q.W, W * q.W - X * q.X - Y * q.Y - Z * q.Z};
  }
  FVector RotateVector(const FVector &v) const {
    const FQuat turned = *this * FQuat(v.X, v.Y, v.Z, 0.0) * FQuat(-X, -Y, -Z, W);
    return {turned.X, turned.Y, turned.Z};
  }
};

struct FTransform {
  FQuat Rotation;
  FVector Translation, Scale;
  FTransform() = default;
  FTransform(const FQuat &q, const FVector &t, const FVector &s)
      : Rotation(q), Translation(t), Scale(s) {}
  FVector InverseTransformVectorNoScale(const FVector &v) const { return v; }
  FVector Of(const FVector &v) const {
    return Translation +
           Rotation.RotateVector({v.X * Scale.X, v.Y * Scale.Y, v.Z * Scale.Z});
  }
};

template <class T>
struct TArray : std::vector<T> {
  int32 Num() const { return static_cast<int32>(this->size()); }
  void SetNum(int32 count) { this->resize(static_cast<size_t>(count)); }
};

class UInstancedStaticMeshComponent {
 public:
  typedef UInstancedStaticMeshComponent Super;
  virtual ~UInstancedStaticMeshComponent() = default;
  virtual void BeginPlay() {}
  virtual void TickComponent(float, ELevelTick, FActorComponentTickFunction *) {}
  FActorComponentTickFunction PrimaryComponentTick;
  FTransform GetComponentTransform() const { return {}; }
  TArray<FTransform> Placed;
  void AddInstances(const TArray<FTransform> &all, bool) { Placed = all; }
  bool BatchUpdateInstancesTransforms(int32, const TArray<FTransform> &all, bool, bool, bool) {
    if (Placed.size() == all.size()) Placed = all;
    return true;
  }
};

#include "TreeInUnreal.h"

static void print(const FVector &v) { printf("%.9g %.9g %.9g\n", v.X, v.Y, v.Z); }

int main(int, char **arguments) {
  const double turn[] = {0.1, 0.7, -0.5, 0.5}, point[] = {1.0, 2.0, 3.0};
  print(UTreeInUnreal::Rotation(turn).RotateVector(UTreeInUnreal::Point(point)));
  UTreeInUnreal tree;
  tree.File = FString((std::string(arguments[1]) + "/tree.sway").c_str());
  tree.Wind = FVector(8.0, -1.0, 0.0);
  tree.BeginPlay();
  for (int frame = 0; frame < 64; frame++) tree.TickComponent(1.0f / 64, LEVELTICK_All, nullptr);
  for (const FTransform &wood : tree.Placed) {
    print(wood.Of({0.0, 0.0, -50.0}));
    print(wood.Of({0.0, 0.0, 50.0}));
    print(wood.Of({50.0, 0.0, -50.0}));
  }
  return tree.PrimaryComponentTick.bCanEverTick ? 0 : 1;
}
