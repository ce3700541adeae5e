// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Unreal 5: x east, -y north, z up, left-handed, in centimetres. One mesh instance a segment: give
// it /Engine/BasicShapes/Cylinder, which is 100 high and thick.
#pragma once

#include "Components/InstancedStaticMeshComponent.h"
#include "CoreMinimal.h"
#include "sway.hpp"

#include "TreeInUnreal.generated.h"

UCLASS(meta = (BlueprintSpawnableComponent))
class UTreeInUnreal : public UInstancedStaticMeshComponent {
  GENERATED_BODY()

public:
  UPROPERTY(EditAnywhere)
  FString File = TEXT("oak.sway");  // whole path, or from the folder of the program

  // Where the air goes, in the world [m/s].
  UPROPERTY(EditAnywhere, BlueprintReadWrite)
  FVector Wind = FVector(5.0, 0.0, 0.0);

  UTreeInUnreal() { PrimaryComponentTick.bCanEverTick = true; }

  static FVector Point(const double *p) { return FVector(100 * p[0], -100 * p[1], 100 * p[2]); }

  static FQuat Rotation(const double *q) { return FQuat(q[0], -q[1], q[2], -q[3]); }

  virtual void BeginPlay() override {
    Super::BeginPlay();
    if (!Tree.open(TCHAR_TO_UTF8(*File)))
      UE_LOG(LogTemp, Error, TEXT("%s"), UTF8_TO_TCHAR(Tree.error.c_str()));
    Wood.SetNum(static_cast<int32>(Tree.lengths.size()));
    AddInstances(Wood, false);
  }

  virtual void TickComponent(float Seconds, ELevelTick Kind,
                             FActorComponentTickFunction *Function) override {
    Super::TickComponent(Seconds, Kind, Function);
    const FVector Air = GetComponentTransform().InverseTransformVectorNoScale(Wind);
    Tree.step(Air.X, -Air.Y, Air.Z, Seconds);
    const FQuat Lying(0.0, UE_DOUBLE_INV_SQRT_2, 0.0, UE_DOUBLE_INV_SQRT_2);  // its z axis on x
    for (int32 i = 0; i < Wood.Num(); i++) {
      const double *Pose = &Tree.poses[7 * i], Long = Tree.lengths[i], Thick = Tree.diameters[i];
      const FQuat Turn = Rotation(Pose + 3);
      const FVector Middle = Point(Pose) + Turn.RotateVector(FVector(50 * Long, 0.0, 0.0));
      Wood[i] = FTransform(Turn * Lying, Middle, FVector(Thick, Thick, Long));
    }
    if (Wood.Num()) BatchUpdateInstancesTransforms(0, Wood, false, true, true);
  }

private:
  sway::Tree Tree;
  TArray<FTransform> Wood;
};
